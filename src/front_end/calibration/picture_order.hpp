#pragma once

#include <vector>

#include "fathom/front_end/calibration.hpp"
#include "odometry_track.hpp"
#include "set_up_fit.hpp"

namespace fathom {

/// Motions with the times of the places where their pictures belong.
std::vector<SeenMotion> put_in_place(const CalibrationInput& input,
                                     const std::vector<MovedPictures>& moved);

/// How likely the motions are that dead reckoning covers: places outside of it explain nothing.
double evidence_of(const CalibrationInput& input, const SetUpFit& fit);

/// Pictures that belong elsewhere in the order, as far as registered motions tell: the most likely
/// places under one of the set-ups and under what is fitted then. Empty where these explain the
/// motions hardly better than `evidence`, or where one shift of all would do, which is a clock's.
std::vector<MovedPictures> find_moved(const CalibrationInput& input, const OdometryTrack& track,
                                      const SetUpPrior& prior,
                                      const std::vector<SetUpParameters>& starts, double evidence);

}  // namespace fathom

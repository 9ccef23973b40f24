#pragma once

#include <optional>

#include "fathom/front_end/calibration.hpp"
#include "odometry_track.hpp"

namespace fathom {

/// The format and order that fit best, and what is off then. Nothing where too few motions are
/// covered.
std::optional<SetUp> find_set_up(const CalibrationInput& input);

/// The convention of a vehicle whose pictures are mirrored where this one is found of pictures as
/// they are.
OdometryConvention mirrored(OdometryConvention convention);

/// How ground truth turns where dead reckoning of the format turns; without a source where it does
/// not say.
TurnComparison compare_with_truth(const CalibrationInput& input, const OdometryTrack& track);

/// The source of a TurnComparison: how the positions of ground truth turn, whatever its headings.
inline constexpr const char* kTruthPath = "the path of ground truth";

/// By source, how it turns where dead reckoning of the format turns.
std::vector<TurnComparison> compare_turns(const CalibrationInput& input,
                                          const OdometryTrack& track);

/// By source, whose turns are known, how its ways are turned against those of dead reckoning.
std::vector<DirectionComparison> compare_directions(const CalibrationInput& input,
                                                    const OdometryTrack& track,
                                                    const std::vector<TurnComparison>& turns);

}  // namespace fathom

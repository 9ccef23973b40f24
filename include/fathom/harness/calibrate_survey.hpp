#pragma once

#include <cstddef>

#include "fathom/front_end/calibration.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/survey.hpp"

namespace fathom {

/// What near frames of a survey say of its set-up, and how many pairs were registered for it.
struct SurveyCalibration {
  Calibration calibration;
  std::size_t tried = 0;
  std::size_t found = 0;
};

/// Registers at most 250 pairs of consecutive keyframes: of a long survey stretches of it, evenly
/// spread. Where these hardly register, of consecutive frames: dead reckoning may be that wrong.
/// Throws InputError where a picture cannot be read.
SurveyCalibration calibrate_survey(Survey& survey, const FrontEndOptions& options,
                                   const Progress& progress = {});

}  // namespace fathom

#pragma once

#include <optional>

#include "fathom/front_end/calibration.hpp"
#include "set_up_fit.hpp"

namespace fathom {

/// The one time at which reckoned over registered lengths change, as least absolute deviations have
/// it; nothing where they do not, by their spread and by 5 %.
std::optional<SetUp::Step> find_step_of_scale(const CalibrationInput& input, const SetUpFit& fit);

}  // namespace fathom

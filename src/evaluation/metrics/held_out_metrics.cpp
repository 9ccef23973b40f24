// Loops that a second run was not given, and what its estimate says of them: what needs no ground
// truth.

#include "groups.hpp"

namespace fathom {

std::vector<Metric> held_out_metrics() {
  const auto count = [](const JudgedRun& run) -> std::optional<double> {
    if (run.facts.held_out == nullptr) return std::nullopt;
    return static_cast<double>(run.facts.held_out->loops.size());
  };
  const auto of = [](auto HeldOutErrors::*field) {
    return [field](const JudgedRun& run) -> std::optional<double> {
      if (!run.held_out) return std::nullopt;
      return (*run.held_out).*field;
    };
  };
  return {
      {"held_out_loops", "held-out loops", "", Better::neither,
       "loops that a second run was not given (evaluation.held_out_loops)", count},
      {"held_out_position_error_m", "position error of held-out loops", "m", Better::lower,
       "median distance between a held-out loop and the estimate without it",
       of(&HeldOutErrors::position_median_m)},
      {"held_out_position_rmse_m", "position RMSE of held-out loops", "m", Better::lower,
       "root mean square of the same distances", of(&HeldOutErrors::position_rmse_m)},
      {"held_out_heading_error_rad", "heading error of held-out loops", "rad", Better::lower,
       "median of the absolute wrapped differences in heading of the same",
       of(&HeldOutErrors::heading_median_rad)},
      {"held_out_heading_rmse_rad", "heading RMSE of held-out loops", "rad", Better::lower,
       "root mean square of these differences", of(&HeldOutErrors::heading_rmse_rad)},
      {"held_out_nis", "NIS of held-out loops", "", Better::neither,
       "mean of held-out loops with the covariance of the estimate without them; 3 expected, "
       "above: overconfident",
       of(&HeldOutErrors::mean_nis)},
  };
}

}  // namespace fathom

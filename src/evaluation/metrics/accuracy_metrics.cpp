#include "groups.hpp"

namespace fathom {

std::vector<Metric> accuracy_metrics() {
  using Judged = std::optional<Accuracy> JudgedRun::*;
  const auto error_of = [](Judged judged, double Accuracy::*field) {
    return [judged, field](const JudgedRun& run) -> std::optional<double> {
      if (!(run.*judged)) return std::nullopt;
      return (*(run.*judged)).*field;
    };
  };
  const auto error = [&](double Accuracy::*field) { return error_of(&JudgedRun::accuracy, field); };
  const auto of_frames = [&](double Accuracy::*field) {
    return error_of(&JudgedRun::frame_accuracy, field);
  };
  std::vector<Metric> metrics{
      {"mean_position_error_m", "mean position error", "m", Better::lower,
       "mean distance to ground truth over the keyframes, the error of the paper",
       error(&Accuracy::mean_position_error_m)},
      {"ate_rmse_m", "ATE RMSE", "m", Better::lower,
       "root mean square distance to ground truth (absolute trajectory error)",
       error(&Accuracy::ate_rmse_m)},
      {"max_position_error_m", "max position error", "m", Better::lower,
       "largest distance to ground truth", error(&Accuracy::max_position_error_m)},
      {"final_position_error_m", "final position error", "m", Better::lower,
       "distance to ground truth at the last keyframe", error(&Accuracy::final_position_error_m)},
      {"heading_rmse_rad", "heading RMSE", "rad", Better::lower,
       "root mean square of wrapped heading differences", error(&Accuracy::heading_rmse_rad)},
      {"frame_mean_position_error_m", "mean position error of all frames", "m", Better::lower,
       "mean distance to ground truth over all frames that have it, each where dead reckoning has "
       "it from its keyframe on",
       of_frames(&Accuracy::mean_position_error_m)},
      {"frame_max_position_error_m", "max position error of all frames", "m", Better::lower,
       "largest distance to ground truth of those frames",
       of_frames(&Accuracy::max_position_error_m)},
  };
  for (Metric& metric : metrics) metric.is_aligned = true;
  return metrics;
}

}  // namespace fathom

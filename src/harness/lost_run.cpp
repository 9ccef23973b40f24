#include <limits>

#include "fathom/harness/replay.hpp"

namespace fathom {

Run lost_run(const MeasurementLog& log, const ReplayOptions& options, Outcome outcome,
             const std::string& fault) {
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  Run result;
  result.outcome = outcome;
  result.fault = fault;
  result.trajectory.assign(log.size(), Pose{kUnknown, kUnknown, kUnknown});
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    for (const RelativePose& z : arrival.registrations) {
      result.loops.push_back({z.from, z.to, LoopFate::lost, std::nullopt});
    }
    for (const AbsolutePose& z : arrival.absolute) {
      result.absolute.push_back({z.keyframe, LoopFate::lost, std::nullopt});
    }
  }
  result.loop_weights.assign(result.loops.size(), 0.0);
  result.absolute_weights.assign(result.absolute.size(), 0.0);
  result.motions = options.motions;
  for (JudgedMotions& motions : result.motions) motions.covariances.clear();
  // Which F it would have minimised was not said.
  if (log.tells_shared_errors()) {
    result.chi2_initial = kUnknown;
  } else {
    result.chi2_initial = chi2(log, options.start.empty() ? log.odometry() : options.start);
  }
  result.chi2_used = result.absolute_chi2_used = kUnknown;
  return result;
}

}  // namespace fathom

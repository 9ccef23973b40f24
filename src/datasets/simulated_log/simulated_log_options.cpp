#include <utility>

#include "simulated_log.hpp"

namespace fathom {

void SimulatedLoopOptions::describe(OptionTable& table) {
  table.real("max_distance_m", max_distance_m, Range::at_least(0), "m",
             "pairs of keyframes whose true distance is below this are tried");
  table.real("probability", probability, Range::between(0, 1), "",
             "of a pair's success at distance 0, falling in a line to 0 at max_distance_m");
  table.integer_or_off("max_per_keyframe", max_per_keyframe, Range::at_least(1), "registrations",
                       "so many at most, the nearest");
  noise.describe(table);
  table.real("shared_sigma_m", shared_sigma_m, Range::at_least(0), "m",
             "error of a keyframe's picture along x and y each, in all its registrations");
  table.real("shared_sigma_rad", shared_sigma_rad, Range::at_least(0), "rad", "the same, heading");
  table.boolean("shared_is_told", shared_is_told,
                "whether covariances have it, and estimators are told that it is shared");
  table.real("scale_error", scale_error, Range::between(-0.5, 0.5), "",
             "not in the covariance: share by which measured distances are too long");
  table.real("tail_share", tail_share, Range::between(0, 1), "",
             "not in the covariance: share of registrations with errors tail_factor as large");
  table.real("tail_factor", tail_factor, Range::at_least(1), "", "of tail_share");
}

void SimulatedLogOptions::describe(OptionTable& table) {
  table.group("mission", mission);
  table.integer("separation_frames", separation_frames, Range::at_least(1), "frames",
                "frames from one keyframe to the next");
  describe_trial(table);
}

void SimulatedLogOptions::describe_trial(OptionTable& table) {
  table.group("odometry", odometry);
  table.group("loops", loops);
  sensors.describe(table);
  table.group("start", start);
}

std::vector<IgnoredKey> SimulatedLogOptions::ignored_keys() const {
  std::vector<IgnoredKey> ignored = below("mission", mission.ignored_keys());
  if (loops.shared_sigma_m == 0.0 && loops.shared_sigma_rad == 0.0) {
    ignored.push_back({"loops.shared_is_told", "loops.shared_sigma_m"});
  }
  if (loops.tail_share == 0.0) ignored.push_back({"loops.tail_factor", "loops.tail_share"});
  for (IgnoredKey& key : sensors.ignored_keys()) ignored.push_back(std::move(key));
  return ignored;
}

}  // namespace fathom

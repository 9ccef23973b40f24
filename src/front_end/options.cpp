#include "fathom/front_end/options.hpp"

namespace fathom {

void FrontEndOptions::describe(OptionTable& table) {
  table.integer("keyframes.separation_frames", separation_frames, Range::at_least(1), "frames",
                "a keyframe every so many frames");
  table.group("candidates", candidates);
  describe_registration(table);
  table.real("visual_odometry.fallback_sigma_m", visual_odometry.sigma_m, Range::positive(), "m",
             "uncertainty of a motion repeated because consecutive pictures do not register");
  table.real("visual_odometry.fallback_sigma_rad", visual_odometry.sigma_rad, Range::positive(),
             "rad", "likewise, of its heading");
}

void FrontEndOptions::describe_registration(OptionTable& table) {
  table.group("features", features);
  registration.describe(table);
}

std::vector<IgnoredKey> FrontEndOptions::ignored_keys() const {
  std::vector<IgnoredKey> ignored;
  for (const std::string& key : candidates.ignored_keys()) {
    ignored.push_back({"candidates." + key, "candidates.method"});
  }
  const bool by_inliers = registration.decision.method == DecisionOptions::Method::inliers;
  ignored.push_back({by_inliers ? "decision.max_false_alarms" : "ransac.score", "decision.method"});
  const auto ignore_tuning = [&](const std::string& group, const std::string& chooser) {
    RegistrationTuning tuning;
    OptionTable table;
    tuning.describe(table);
    for (const std::string& key : table.keys()) {
      if (key.starts_with(group)) ignored.push_back({"registration_tuning." + key, chooser});
    }
  };
  if (!features.flatten) ignore_tuning("features.", "features.flatten");
  if (by_inliers) {
    for (const char* group : {"matching.", "decision.", "fit."}) {
      ignore_tuning(group, "decision.method");
    }
  }
  return ignored;
}

}  // namespace fathom

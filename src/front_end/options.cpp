#include "fathom/front_end/options.hpp"

namespace fathom {

void FrontEndOptions::describe(OptionTable& table) {
  table.group("keyframes", keyframes);
  table.group("candidates", candidates);
  describe_registration(table);
  table.enumeration<RepeatedKeypoints>(
      "repeated_keypoints", repeated_keypoints,
      {{"once", RepeatedKeypoints::once}, {"independent", RepeatedKeypoints::independent}},
      "keypoints that several registrations of a picture have in common count once in their own "
      "covariances, or in each as if it were alone");
  table.real("visual_odometry.fallback_sigma_altitudes", visual_odometry.sigma_altitudes,
             Range::positive(), "altitudes",
             "uncertainty in x and y of a motion repeated because consecutive pictures do not "
             "register");
  table.real_or_off("visual_odometry.fallback_sigma_m", visual_odometry.sigma_m, Range::positive(),
                    "m", "likewise, whatever the altitude");
  table.real("visual_odometry.fallback_sigma_rad", visual_odometry.sigma_rad, Range::positive(),
             "rad", "likewise, of its heading");
}

void FrontEndOptions::describe_registration(OptionTable& table) {
  table.enumeration<MaskUse>("mask", mask,
                             {{"automatic", MaskUse::automatic}, {"off", MaskUse::off}},
                             "no features where the picture is no floor: by the data set's mask, "
                             "else where it stays in place over the survey");
  table.group("features", features);
  registration.describe(table);
}

void FrontEndOptions::check() const {
  candidates.check();
}

std::vector<IgnoredKey> FrontEndOptions::ignored_keys() const {
  std::vector<IgnoredKey> ignored;
  for (const std::string& key : keyframes.ignored_keys()) {
    ignored.push_back({"keyframes." + key, "keyframes.separation_frames"});
  }
  for (const std::string& key : candidates.ignored_keys()) {
    ignored.push_back({"candidates." + key, "candidates." + candidates.chooser()});
  }
  if (visual_odometry.sigma_m) {
    ignored.push_back(
        {"visual_odometry.fallback_sigma_altitudes", "visual_odometry.fallback_sigma_m"});
  }
  if (registration.ransac.max_error_m) {
    ignored.push_back({"ransac.max_error_px", "ransac.max_error_m"});
  }
  if (registration.covariance.floor_sigma_m) {
    ignored.push_back({"covariance.floor_sigma_px", "covariance.floor_sigma_m"});
  }
  const bool by_inliers = registration.decision.method == DecisionOptions::Method::inliers;
  ignored.push_back({by_inliers ? "decision.max_false_alarms" : "ransac.score", "decision.method"});
  if (by_inliers) {
    ignored.push_back({"decision.first_features", "decision.method"});
    ignored.push_back({"decision.first_max_false_alarms", "decision.method"});
  } else if (!registration.decision.first_features) {
    ignored.push_back({"decision.first_max_false_alarms", "decision.first_features"});
  }
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

#include <utility>

#include "simulated_survey.hpp"

namespace fathom {

void AltitudeOptions::describe(OptionTable& table) {
  table.real("base_m", base_m, Range::positive(), "m",
             "mean altitude of the camera over the floor");
  table.real("amplitude_m", amplitude_m, Range::at_least(0), "m", "of its sine over time");
  table.real("period_s", period_s, Range::positive(), "s", "of its sine over time");
  table.real("altimeter_sigma_m", altimeter_sigma_m, Range::at_least(0), "m",
             "standard deviation of a measured altitude");
}

void SimulatedSurveyOptions::describe(OptionTable& table) {
  table.group("world", world);
  table.group("mission", mission);
  table.group("altitude", altitude);
  table.group("camera", camera);
  table.group("odometry", odometry);
  table.group("attitude", attitude);
  table.group("water", effects.water);
  table.group("camera_effects", effects.camera);
  sensors.describe(table);
  table.group("start", start);
}

void SimulatedSurveyOptions::describe_trial(OptionTable& table) {
  table.group("odometry", odometry);
  sensors.describe(table);
  table.group("start", start);
}

std::string SimulatedSurveyOptions::why_surveys_are_alike() const {
  const bool draws = world.picture.empty() || world.relief_m > 0.0 || !attitude.is_level() ||
                     attitude.measured_sigma_rad.value_or(0.0) > 0.0 || effects.is_random() ||
                     altitude.altimeter_sigma_m > 0.0;
  if (draws) return "";
  return "over the picture of dataset.world a level camera, exact altitudes and clear pictures "
         "leave "
         "nothing to draw";
}

std::vector<IgnoredKey> SimulatedSurveyOptions::ignored_keys() const {
  std::vector<IgnoredKey> ignored = below("mission", mission.ignored_keys());
  for (IgnoredKey& key : below("odometry", odometry.ignored_keys())) {
    ignored.push_back(std::move(key));
  }
  if (odometry.source == OdometrySource::kVisualOdometry) {
    // Its motions are of all pictures.
    for (const char* key :
         {"holes.count", "holes.length_s", "gap_sigma_m", "gap_sigma_rad", "speed_limit_m_s"}) {
      ignored.push_back({key, "odometry.source"});
    }
  }
  for (IgnoredKey& key : sensors.ignored_keys()) ignored.push_back(std::move(key));
  return ignored;
}

}  // namespace fathom

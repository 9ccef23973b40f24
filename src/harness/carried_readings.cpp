#include "carried_readings.hpp"

namespace fathom {
namespace {

StartPose start_at(const Survey& survey, const Configuration& configuration) {
  try {
    return start_of(survey.start(), survey.readings(), dead_reckoning_of(survey.frames()));
  } catch (const InputError& error) {
    throw at_origin(configuration, error);
  }
}

}  // namespace

CarriedReadings::CarriedReadings(const Survey& survey, const Configuration& configuration)
    : is_empty_(survey.readings().is_empty()),
      schedule_(survey.frames(), configuration.front_end.keyframes),
      start_(start_at(survey, configuration)),
      carrier_(survey.readings(), dead_reckoning_of(survey.frames()), start_) {}

std::vector<AbsolutePose> CarriedReadings::next() {
  // The frames ahead, which may be costly, are for those alone who have readings.
  if (is_empty_) return {};
  const std::size_t k = keyframe_++;
  return carrier_.of(k, schedule_.frame(k).value(), schedule_.frame(k + 1));
}

}  // namespace fathom

#pragma once

#include <cstddef>
#include <vector>

#include "fathom/configuration/configuration.hpp"
#include "fathom/datasets/reading_carrier.hpp"
#include "fathom/front_end/keyframes.hpp"
#include "fathom/harness/survey.hpp"

namespace fathom {

/// What compass and positioning system say of each keyframe of a survey, and where they have it
/// start.
class CarriedReadings {
 public:
  /// The survey must outlive it. Throws InputError at the origin of a key that is wrong.
  CarriedReadings(const Survey& survey, const Configuration& configuration);

  const StartPose& start() const { return start_; }

  /// Of the next keyframe, from keyframe 0 on. Frames are asked for up to the keyframe after it.
  std::vector<AbsolutePose> next();

 private:
  bool is_empty_ = true;
  KeyframeSchedule schedule_;
  StartPose start_;
  ReadingCarrier carrier_;
  std::size_t keyframe_ = 0;
};

}  // namespace fathom

#pragma once

#include <cstdint>
#include <utility>
#include <vector>

#include "fathom/front_end/front_end.hpp"
#include "front_end/floor_survey.hpp"

namespace fathom::test {

inline Eigen::Matrix3d step_covariance() {
  Eigen::Matrix3d C;
  C << 4e-4, 1e-4, -5e-5,  //
      1e-4, 2e-4, 3e-5,    //
      -5e-5, 3e-5, 1e-4;
  return C;
}

inline FrontEndOptions keyframe_every(int frames, double max_distance_m = 100.0) {
  FrontEndOptions options;
  options.keyframes.separation_frames = frames;
  options.candidates.max_distance_m = max_distance_m;
  return options;
}

/// A trajectory that somebody else estimated.
class Given : public TrajectoryView {
 public:
  explicit Given(std::vector<Pose> poses) : poses_(std::move(poses)) {}
  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }

 private:
  std::vector<Pose> poses_;
};

inline Given truth_of(const FloorSurvey& survey) {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < survey.size(); ++i) poses.push_back(survey.truth(i));
  return Given(poses);
}

/// The front end over a survey, with every registration that it finds.
struct SurveyRun {
  SurveyRun(const FrameSource& survey, const TrajectoryView& view, const FrontEndOptions& options,
            std::uint64_t seed = 1)
      : registrar(survey, options.features, options.registration, seed),
        front_end(survey, registrar, options) {
    while (const auto keyframe = front_end.next_keyframe()) {
      for (RelativePose& z : front_end.register_newest(view)) registrations.push_back(z);
    }
  }

  PairRegistrar registrar;
  FrontEnd front_end;
  std::vector<RelativePose> registrations;
};

}  // namespace fathom::test

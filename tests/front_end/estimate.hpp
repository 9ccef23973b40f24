#pragma once

#include <optional>
#include <span>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fathom/front_end/candidates.hpp"

namespace fathom::test {

/// An estimate made by hand. `sigma_m` of a keyframe: of its motion to the newest, in x and y.
class Estimate : public TrajectoryView {
 public:
  explicit Estimate(std::vector<Pose> poses, std::vector<double> sigma_m = {})
      : poses_(std::move(poses)), sigma_m_(std::move(sigma_m)) {}

  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override {
    if (sigma_m_.empty()) return std::nullopt;
    std::vector<UncertainPose> motions;
    for (std::size_t k = 0; k < sigma_m_.size(); ++k) {
      const double variance = sigma_m_[k] * sigma_m_[k];
      motions.push_back({between(poses_[k], poses_.back()),
                         Eigen::Vector3d(variance, variance, 0.01).asDiagonal()});
    }
    return motions;
  }

 private:
  std::vector<Pose> poses_;
  std::vector<double> sigma_m_;
};

// A picture covers 2 m along x and 3 m along y from 1 m up: 300 × 200 pixels, focal length 100.
inline Camera wide_camera() {
  CameraModel model;
  model.width = 300;
  model.height = 200;
  model.fx = model.fy = 100.0;
  model.cx = 149.5;
  model.cy = 99.5;
  return Camera(model);
}

inline constexpr CandidateMethod kMethods[] = {
    CandidateMethod::distance, CandidateMethod::mahalanobis, CandidateMethod::overlap,
    CandidateMethod::possible_overlap};

inline CandidateOptions by(CandidateMethod method) {
  CandidateOptions options;
  options.method = method;
  options.max_distance_m = 3.0;
  return options;
}

inline Candidates candidates(CandidateSearch& search, const TrajectoryView& estimate,
                             std::vector<Stance> stances = {},
                             std::span<const std::size_t> holes = {}) {
  stances.resize(estimate.size(), 1.0);
  return search.find(estimate, stances, estimate.size() - 1, holes);
}

inline Candidates candidates(const CandidateOptions& options, const TrajectoryView& estimate,
                             std::vector<Stance> stances = {},
                             std::span<const std::size_t> holes = {}) {
  CandidateSearch search(wide_camera(), options);
  return candidates(search, estimate, std::move(stances), holes);
}

}  // namespace fathom::test

#pragma once

#include <vector>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom::test {

/// A full covariance of (x, y, θ).
inline Eigen::Matrix3d square_covariance() {
  Eigen::Matrix3d C;
  C << 4e-4, 1e-4, -5e-5,  //
      1e-4, 2e-4, 3e-5,    //
      -5e-5, 3e-5, 1e-4;
  return C;
}

/// True poses: twice round a square of 1 m, keyframe k + 4 where keyframe k was.
inline std::vector<Pose> square_truth() {
  std::vector<Pose> poses{{0.5, -0.25, 0.3}};
  while (poses.size() < 8) poses.push_back(compose(poses.back(), {1.0, 0.0, M_PI / 2}));
  return poses;
}

/// Its log: the steps a little off, and exact loops 0-4; 1-5 and 2-5; 3-7.
inline MeasurementLog square_log() {
  const std::vector<Pose> truth = square_truth();
  MeasurementLog log(truth.front());
  const auto loop = [&](std::size_t from, std::size_t to) {
    log.add_registration(RelativePose::from_covariance(from, to, between(truth[from], truth[to]),
                                                       0.1 * square_covariance()));
  };
  for (std::size_t k = 1; k < truth.size(); ++k) {
    const Pose motion = compose(between(truth[k - 1], truth[k]), {0.02, -0.01, 0.015});
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, motion, square_covariance()));
    if (k == 4) loop(0, 4);
    if (k == 5) loop(1, 5);
    if (k == 5) loop(2, 5);
    if (k == 7) loop(3, 7);
  }
  return log;
}

}  // namespace fathom::test

#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/random.hpp"
#include "fathom/geometry/pose.hpp"
#include "vision/points.hpp"

namespace fathom::test {

inline Points random_points(RandomStream& random, int count, const Eigen::Vector2d& middle) {
  Points points;
  for (int i = 0; i < count; ++i) {
    const double x = random.uniform(-1.0, 1.0);
    points.push_back(middle + Eigen::Vector2d(x, random.uniform(-1.0, 1.0)));
  }
  return points;
}

inline Points seen_from(const Pose& z, const Points& q) {
  Points p;
  for (const Eigen::Vector2d& point : q) p.push_back(transform(z, point));
  return p;
}

inline std::vector<double> random_weights(RandomStream& random, std::size_t count) {
  std::vector<double> weights;
  for (std::size_t j = 0; j < count; ++j) weights.push_back(std::exp(random.normal()));
  return weights;
}

inline Eigen::Vector3d difference(const Pose& a, const Pose& b) {
  return {a.x - b.x, a.y - b.y, wrap_angle(a.theta - b.theta)};
}

}  // namespace fathom::test

#pragma once

#include <vector>

#include <Eigen/Core>

#include "fathom/core/random.hpp"

namespace fathom::test {

using Points = std::vector<Eigen::Vector2d>;

/// An error of a point, alike in x and y.
inline Eigen::Vector2d noise(RandomStream& random, double sigma_m) {
  const double x = sigma_m * random.normal();
  return {x, sigma_m * random.normal()};
}

}  // namespace fathom::test

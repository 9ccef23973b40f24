#pragma once

#include <cstdint>

#include <Eigen/Core>

#include "fathom/core/random.hpp"
#include "fathom/vision/ransac.hpp"
#include "vision/points.hpp"

namespace fathom::test {

/// Matched points: p = z ⊕ q, with errors.
struct Pairs {
  Points p;
  Points q;

  void add(const Pose& z, const Eigen::Vector2d& point, const Eigen::Vector2d& noise = {0.0, 0.0}) {
    p.push_back(transform(z, point) + noise);
    q.push_back(point);
  }
  Consensus found(const RansacOptions& options, std::uint64_t seed = 1) const {
    return ransac(p, q, options, seed);
  }
};

inline Eigen::Vector2d anywhere(RandomStream& random, double size_m = 1.0) {
  const double x = random.uniform(-size_m, size_m);
  return {x, random.uniform(-size_m, size_m)};
}

inline void add_true(Pairs& pairs, RandomStream& random, const Pose& z, int count, double sigma_m) {
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector2d point = anywhere(random);
    pairs.add(z, point, noise(random, sigma_m));
  }
}

inline void add_wrong(Pairs& pairs, RandomStream& random, int count) {
  for (int i = 0; i < count; ++i) {
    pairs.p.push_back(anywhere(random));
    pairs.q.push_back(anywhere(random));
  }
}

inline const Pose kTruth{0.4, -0.2, 2.5};

}  // namespace fathom::test

#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "tests/estimators/logs.hpp"

namespace fathom::test {

// Measurements of poses with a full covariance, and noise to suit it but for its shape.
inline RelativePose measured(std::span<const Pose> truth, std::size_t from, std::size_t to,
                             double sigma_m, double sigma_rad, RandomStream& random) {
  return RelativePose::from_covariance(
      from, to, perturbed(between(truth[from], truth[to]), sigma_m, sigma_rad, random),
      full_covariance(sigma_m, sigma_rad));
}

// A random walk that turns through ±π, with up to four loops at once to any earlier keyframes,
// written either way round, and stretches without any.
inline MeasurementLog wandering_log(std::size_t keyframes, std::uint64_t seed) {
  RandomStream random(seed, "wandering");
  std::vector<Pose> truth{{1.0, -2.0, 3.1}};
  MeasurementLog log(truth[0]);
  for (std::size_t k = 1; k < keyframes; ++k) {
    truth.push_back(compose(truth.back(), {0.8, 0.1 * random.normal(), 0.5 * random.normal()}));
    log.add_keyframe(measured(truth, k - 1, k, 0.03, 0.01, random));
    if (random.uniform(0.0, 1.0) < 0.6) continue;
    const int loops = 1 + static_cast<int>(random.uniform(0.0, 3.99));
    for (int j = 0; j < loops; ++j) {
      const auto other = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(k)));
      const bool backward = random.uniform(0.0, 1.0) < 0.5;
      log.add_registration(
          measured(truth, backward ? k : other, backward ? other : k, 0.05, 0.02, random));
    }
  }
  return log;
}

// Parallel tracks, there and back, with a loop to the track before at every third keyframe.
inline MeasurementLog tracks_log(std::size_t keyframes, std::size_t along_track) {
  RandomStream random(4, "tracks");
  std::vector<Pose> truth;
  for (std::size_t k = 0; k < keyframes; ++k) {
    const std::size_t track = k / along_track;
    const std::size_t along = k % along_track;
    const bool back = track % 2 == 1;
    truth.push_back({static_cast<double>(back ? along_track - 1 - along : along),
                     2.0 * static_cast<double>(track), back ? M_PI : 0.0});
  }
  MeasurementLog log(truth[0]);
  for (std::size_t k = 1; k < keyframes; ++k) {
    log.add_keyframe(measured(truth, k - 1, k, 0.02, 0.005, random));
    if (k < along_track || k % 3 != 0) continue;
    log.add_registration(measured(truth, k - (2 * (k % along_track) + 1), k, 0.03, 0.01, random));
  }
  return log;
}

}  // namespace fathom::test

#include "survey.hpp"

#include <cmath>

#include "benchmarks/noisy_motion.hpp"

namespace fathom::benchmarks {
namespace {

Pose true_pose(std::size_t k, std::size_t along_track) {
  const std::size_t track = k / along_track;
  const std::size_t along = k % along_track;
  const bool back = track % 2 == 1;
  const std::size_t x = back ? along_track - 1 - along : along;
  return {static_cast<double>(x), 2.0 * static_cast<double>(track), back ? M_PI : 0.0};
}

RelativePose measured(std::size_t from, std::size_t to, std::size_t along_track, double sigma_m,
                      double sigma_rad, RandomStream& noise) {
  return noisy_motion(from, true_pose(from, along_track), to, true_pose(to, along_track), sigma_m,
                      sigma_rad, noise);
}

}  // namespace

MeasurementLog parallel_tracks(std::size_t keyframes, std::size_t loops) {
  RandomStream noise(1, "survey");
  const auto along_track = static_cast<std::size_t>(std::sqrt(static_cast<double>(keyframes)));
  const double due = static_cast<double>(loops) / static_cast<double>(keyframes - along_track);
  MeasurementLog log(true_pose(0, along_track));
  double owed = 0.0;
  for (std::size_t k = 1; k < keyframes; ++k) {
    log.add_keyframe(measured(k - 1, k, along_track, 0.02, 0.005, noise));
    if (k < along_track) continue;
    owed += due;
    if (owed < 1.0) continue;
    owed -= 1.0;
    const std::size_t back = 2 * (k % along_track) + 1;
    log.add_registration(measured(k - back, k, along_track, 0.03, 0.01, noise));
  }
  return log;
}

}  // namespace fathom::benchmarks

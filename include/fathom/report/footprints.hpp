#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/pose.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// A keyframe's picture as an estimate has it.
struct KeyframePicture {
  std::int64_t time_ns = 0;
  Stance stance;
  Pose pose;  ///< of the body, in the map
};

/// What a keyframe's picture covers, and how much of it others see too. Overlaps are shares of the
/// smaller one of two footprints, 0 to 1.
struct Footprint {
  std::size_t keyframe = 0;
  std::int64_t time_ns = 0;
  /// Top left, top right, bottom right, bottom left of the picture; map, m.
  std::array<Eigen::Vector2d, 4> corners;
  std::optional<double> overlap_previous;  ///< with the keyframe before; nothing of the first
  /// The largest with a keyframe of another pass: one that a keyframe without any overlap with this
  /// one lies between. Of the 16 such whose footprints' middles are nearest.
  double overlap_other_pass = 0.0;
  std::optional<std::size_t> other_pass;  ///< that keyframe; nothing where none overlaps
};

/// One a keyframe. The work grows with the keyframes that are near each other, not with their
/// square. Throws InputError on an altitude that is not positive or a pose that is not finite.
std::vector<Footprint> footprints(const Camera& camera, std::span<const KeyframePicture> keyframes);

/// The content of footprints.csv (docs/outputs.md).
std::string footprints_csv(std::span<const Footprint> footprints);

}  // namespace fathom

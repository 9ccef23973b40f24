#pragma once

#include <array>
#include <cstdint>

#include <Eigen/Core>

namespace fathom {

/// The net of bright lines that waves at the surface draw on a floor: the ridge of a sum of warped
/// plane waves, some 0.2 to 0.5 m from line to line. Every seed has directions, wavelengths and
/// phases of its own, so two pictures of one place have unrelated nets.
class Caustics {
 public:
  /// `share`: greatest departure from a gain of 1; 0 is off.
  Caustics(double share, std::uint64_t seed);

  bool are_off() const { return share_ == 0.0F; }

  /// In [1 − share, 1 + share], about 1 on average, at a point in metres.
  float gain(const Eigen::Vector2f& point) const;

 private:
  struct Wave {
    Eigen::Vector2f radians_per_metre;
    float phase_rad;
    float at(const Eigen::Vector2f& point, float warp_rad) const;
  };

  float share_;
  std::array<Wave, 3> waves_;
  std::array<Wave, 2> warps_;
};

}  // namespace fathom

#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "fathom/core/random.hpp"
#include "src/datasets/simulated/floor_renderer.hpp"

namespace fathom::test {

/// The mean altitude of all pairs, which conditions are scaled to.
inline constexpr double kNominalAltitudeM = 2.0;

/// Under what a pair of pictures is taken.
struct Condition {
  std::string name;
  PictureEffects effects = {};
  double relief_share = 0.0;  ///< farthest point of the floor from its mean plane, of the altitude
  double tilt_sigma_rad = 0.0;  ///< of roll and pitch, independent in every picture

  double relief_m() const { return relief_share * kNominalAltitudeM; }
};

/// clean, contrast, haze, light_cone, motion_blur, noise, particles, colour_cast, caustics, relief,
/// tilt_2deg, tilt_5deg: one effect each, of the strengths that stand in conditions.cpp.
const std::vector<Condition>& conditions();

/// Throws InputError on a name that is none.
const Condition& condition_named(std::string_view name);

/// A view of its own under a condition: tilt, direction of motion and all that is new in every
/// picture are drawn; pose and altitude are left.
void draw_condition(View& view, const Condition& condition, RandomStream& stream);

}  // namespace fathom::test

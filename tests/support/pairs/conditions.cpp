#include "support/pairs/conditions.hpp"

#include <algorithm>
#include <numbers>

#include "fathom/core/input_error.hpp"

namespace fathom::test {
namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

Condition with(const char* name, void (*set)(PictureEffects&)) {
  Condition condition{name};
  set(condition.effects);
  return condition;
}

std::vector<Condition> make_conditions() {
  return {{"clean"},
          with("contrast", [](PictureEffects& e) { e.camera.contrast = 0.4; }),
          with("haze",
               [](PictureEffects& e) {
                 e.water.attenuation_per_m = attenuation_of(0.6, kNominalAltitudeM);
               }),
          with("light_cone", [](PictureEffects& e) { e.camera.corner_light = 0.4; }),
          with("motion_blur", [](PictureEffects& e) { e.camera.motion_blur_px = 5.0; }),
          with("noise", [](PictureEffects& e) { e.camera.noise_sigma = 8.0; }),
          with("particles", [](PictureEffects& e) { e.water.particles = 200; }),
          with("colour_cast",
               [](PictureEffects& e) {
                 e.camera.colour_cast = {0.45, 0.95, 1.15};
               }),
          with("caustics", [](PictureEffects& e) { e.water.caustics = 0.2; }),
          {"relief", {}, 0.05, 0.0},
          {"tilt_2deg", {}, 0.0, 2.0 * kDegree},
          {"tilt_5deg", {}, 0.0, 5.0 * kDegree}};
}

}  // namespace

const std::vector<Condition>& conditions() {
  static const std::vector<Condition> all = make_conditions();
  return all;
}

const Condition& condition_named(std::string_view name) {
  const auto found = std::ranges::find(conditions(), name, &Condition::name);
  if (found != conditions().end()) return *found;
  std::vector<std::string> names;
  for (const Condition& condition : conditions()) names.push_back(condition.name);
  const std::string wanted(name);
  throw InputError("no condition '" + wanted + "'" + suggestion(wanted, names));
}

void draw_condition(View& view, const Condition& condition, RandomStream& stream) {
  view.tilt.roll_rad = condition.tilt_sigma_rad * stream.normal();
  view.tilt.pitch_rad = condition.tilt_sigma_rad * stream.normal();
  view.motion_rad = stream.uniform(-std::numbers::pi, std::numbers::pi);
  view.seed = stream.index(1ULL << 62);
}

}  // namespace fathom::test

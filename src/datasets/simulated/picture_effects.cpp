#include "picture_effects.hpp"

#include <algorithm>
#include <cmath>

namespace fathom {

void WaterOptions::describe(OptionTable& table) {
  table.real("attenuation_per_m", attenuation_per_m, Range::at_least(0), "1/m",
             "haze: exp(-this x path) of the floor's light arrives; 0: clear");
  table.real("backscatter", backscatter, Range::between(0, 255), "grey",
             "haze: what replaces the light that is lost");
  table.real("caustics", caustics, Range::between(0, 1), "",
             "sunlight on the floor varies by this share, anew in every picture");
  table.integer("particles", particles, Range::between(0, 100000), "",
                "bright specks out of focus, anew in every picture");
}

double attenuation_of(double transmission, double path_m) {
  return -std::log(transmission) / path_m;
}

void CameraEffects::describe(OptionTable& table) {
  table.real("corner_light", corner_light, Range{0.0, 1.0, true}, "",
             "light cone: brightness of the farthest corner over that of the middle");
  table.real("contrast", contrast, Range{0.0, 1.0, true}, "",
             "contrast that is left about the mean grey of a picture");
  table.real("motion_blur_px", motion_blur_px, Range::between(0, 200), "pixels",
             "length of the blur along the direction of motion");
  table.real("noise_sigma", noise_sigma, Range::between(0, 255), "grey",
             "standard deviation of sensor noise, of 255");
  table.reals("colour_cast", colour_cast, 3, "",
              "gains of red, green and blue before the conversion to grey; []: none");
}

bool PictureEffects::is_random() const {
  return water.caustics > 0.0 || water.particles > 0 || camera.noise_sigma > 0.0;
}

bool PictureEffects::any() const {
  return is_random() || water.attenuation_per_m > 0.0 || camera.corner_light < 1.0 ||
         camera.contrast < 1.0 || camera.motion_blur_px > 0.0 || !camera.colour_cast.empty();
}

void PictureEffects::check(const std::string& prefix) const {
  const auto is_gain = [](double gain) { return gain > 0.0 && gain <= 4.0; };
  const std::vector<double>& cast = camera.colour_cast;
  if (!cast.empty() && (cast.size() != 3 || !std::all_of(cast.begin(), cast.end(), is_gain))) {
    throw InputError(prefix + "camera_effects.colour_cast: expected three gains > 0, <= 4, or []");
  }
  if (water.attenuation_per_m == 0.0 && water.backscatter != WaterOptions().backscatter) {
    throw InputError(prefix + "water.backscatter: has no effect in clear water; set " + prefix +
                     "water.attenuation_per_m too");
  }
}

void PictureEffects::add_to(Hash& hash) const {
  hash.add(water.attenuation_per_m).add(water.backscatter).add(water.caustics);
  hash.add(water.particles).add(camera.corner_light).add(camera.contrast);
  hash.add(camera.motion_blur_px).add(camera.noise_sigma).add(camera.colour_cast.size());
  for (const double gain : camera.colour_cast) hash.add(gain);
}

}  // namespace fathom

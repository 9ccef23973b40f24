#pragma once

#include <string>
#include <vector>

#include "fathom/core/hash.hpp"
#include "fathom/core/options.hpp"

namespace fathom {

/// What the water between floor and camera does to a picture (docs/water.md). All off by default.
struct WaterOptions {
  /// c: light travels r metres and t = exp(−c r) of it arrives, the rest being replaced by
  /// backscatter: I = J t + B (1 − t) (Jaffe 1990; Schechner and Karpel 2005).
  double attenuation_per_m = 0.0;
  double backscatter = 128.0;  ///< B, the veiling light: grey of infinitely deep water
  /// Sunlight on the floor, focused by waves: its brightness varies by this share at most, in a
  /// pattern that is new in every picture (Gracias et al. 2008).
  double caustics = 0.0;
  /// Bright specks out of focus, new in every picture: marine snow (Boffety and Galland 2012).
  int particles = 0;

  void describe(OptionTable& table);
};

/// c of the water that lets `transmission` in (0, 1] through along `path_m`.
double attenuation_of(double transmission, double path_m);

/// What lamp, lens and sensor do to it, sources in docs/water.md. All off by default.
struct CameraEffects {
  double corner_light = 1.0;        ///< vignetting: light in the farthest corner over the middle's
  double contrast = 1.0;            ///< about the mean grey of the picture
  double motion_blur_px = 0.0;      ///< how far the floor moves while the shutter is open
  double noise_sigma = 0.0;         ///< grey levels, of 255
  std::vector<double> colour_cast;  ///< gains of red, green and blue; empty: none

  void describe(OptionTable& table);
};

/// All that is done to a picture besides geometry.
struct PictureEffects {
  WaterOptions water;
  CameraEffects camera;

  bool any() const;

  /// Whether a picture depends on its seed.
  bool is_random() const;

  /// Throws InputError naming `prefix` + the key: a colour cast that is not three gains in (0, 4],
  /// or backscatter without attenuation.
  void check(const std::string& prefix) const;

  void add_to(Hash& hash) const;
};

}  // namespace fathom

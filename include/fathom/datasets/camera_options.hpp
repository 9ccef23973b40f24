#pragma once

#include <optional>
#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {

/// The options of a camera; the defaults are those of CameraModel.
struct CameraOptions {
  /// All but the principal point and the distortion, which a config may leave out.
  CameraModel base;
  std::optional<double> cx;  ///< pixels; absent: the middle of the picture
  std::optional<double> cy;
  std::vector<double> distortion;  ///< k1 k2 p1 p2 k3, or empty

  void describe(OptionTable& table);

  /// Throws InputError naming `key_prefix` + the key if the distortion is no list of five.
  CameraModel model(const std::string& key_prefix) const;
};

}  // namespace fathom

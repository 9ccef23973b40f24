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
  std::vector<double> distortion;  ///< the coefficients of base.distortion_model, or empty

  void describe(OptionTable& table);

  /// Throws InputError naming `key_prefix` + the key if the distortion has another number of
  /// coefficients than its model.
  CameraModel model(const std::string& key_prefix) const;
};

/// The keys `prefix` + distortion_model and `prefix` + distortion.
void describe_distortion(OptionTable& table, const std::string& prefix, DistortionModel& model,
                         std::vector<double>& coefficients);

/// Coefficients as those keys give them. Throws InputError that names `key`.
void set_distortion(CameraModel& camera, const std::vector<double>& coefficients,
                    const std::string& key);

}  // namespace fathom

#pragma once

#include <optional>

#include "fathom/core/options.hpp"

namespace fathom {

/// Where a survey starts on Earth: the place and heading of keyframe 0, whose body frame is the
/// frame of every map. Where fixes or a compass say where keyframe 0 is, those of the map's frame.
struct EarthOrigin {
  double latitude_deg = 0.0;   ///< WGS 84, north positive
  double longitude_deg = 0.0;  ///< WGS 84, east positive
  double heading_deg = 0.0;    ///< of the body's x axis, clockwise from true north
};

/// `dataset.origin`, of every data set of pictures. Fixes in latitude and longitude, and headings
/// from north, depend on it, and no other measurement.
struct EarthOriginOptions {
  std::optional<double> latitude;
  std::optional<double> longitude;
  std::optional<double> heading;

  void describe(OptionTable& table);

  bool is_given() const { return latitude || longitude || heading; }

  /// Nothing where none of the three is given. Throws InputError, "KEY: …", where one is missing.
  std::optional<EarthOrigin> origin() const;
};

}  // namespace fathom

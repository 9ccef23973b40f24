#pragma once

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fathom/geometry/covariance.hpp"

namespace fathom {

/// How positions and headings of dead reckoning are given, `convention` of `odometry0`.
enum class OdometryConvention {
  counter_clockwise_from_x,  ///< x, y, and heading from x towards y, seen from above: ours
  north_east_down,           ///< y to starboard of x, heading clockwise
  clockwise_from_x,          ///< y to port of x, heading clockwise all the same
  clockwise_from_y,          ///< x east, y north, heading clockwise from north
  y_to_starboard             ///< y to starboard of x, heading counter-clockwise all the same
};

/// By the word of `sensor.yaml`, the first one the default.
const std::vector<std::pair<std::string, OdometryConvention>>& odometry_conventions();
std::string name_of(OdometryConvention convention);

/// An integrated pose as a sensor gives it: its heading is not wrapped.
struct ReckonedRow {
  std::int64_t time_ns = 0;
  double x_m = 0.0;
  double y_m = 0.0;
  double heading_rad = 0.0;
  bool is_after_hole = false;  ///< nothing was measured of the motion since the row before
};

/// How rows are to be read.
struct OdometryFormat {
  OdometryConvention convention = OdometryConvention::counter_clockwise_from_x;
  bool is_in_degrees = false;  ///< its headings
  double scale = 1.0;          ///< of its positions to metres

  /// The row as a pose of ours, heading wrapped.
  Pose pose(const ReckonedRow& row) const;
  /// Of a step, in axes of ours: of a vehicle whose y is to starboard x and y correlate the other
  /// way. Variances of headings are rad² in any case.
  Eigen::Matrix3d covariance(const Eigen::Matrix3d& stated) const;
};

/// Dead reckoning as its sensor gives it, and how it is read.
struct RecordedOdometry {
  std::vector<ReckonedRow> rows;  ///< by rising time
  OdometryFormat format;
  double time_offset_s = 0.0;  ///< that is in the times of the rows
};

}  // namespace fathom

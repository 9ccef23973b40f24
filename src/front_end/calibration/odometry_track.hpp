#pragma once

#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "fathom/datasets/odometry_rows.hpp"

namespace fathom {

/// The nearest number of nanoseconds.
inline std::int64_t nanoseconds(double seconds) {
  return static_cast<std::int64_t>(std::llround(1e9 * seconds));
}

/// Dead reckoning as a function of time: its rows in some format, at constant velocity between
/// them.
class OdometryTrack {
 public:
  /// `offset_s` is added to its times.
  OdometryTrack(const RecordedOdometry& odometry, const OdometryFormat& format,
                double offset_s = 0.0);

  /// The motion between two times, either way round; nothing where one of them is not covered, or a
  /// hole lies between them.
  std::optional<Pose> motion(std::int64_t from_ns, std::int64_t to_ns) const;

  std::int64_t first_ns() const { return times_ns_.front(); }
  std::int64_t last_ns() const { return times_ns_.back(); }
  bool is_empty() const { return times_ns_.size() < 2; }

 private:
  struct Place {
    Pose pose;
    std::size_t holes = 0;  ///< passed until then
    bool is_in_hole = false;
  };
  std::optional<Place> at(std::int64_t time_ns) const;

  std::vector<std::int64_t> times_ns_;
  std::vector<Pose> poses_;
  std::vector<std::size_t> holes_;  ///< up to each row
};

}  // namespace fathom

#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/datasets/odometry_gaps.hpp"
#include "fathom/geometry/covariance.hpp"
#include "sensor_yaml.hpp"

namespace fathom {

/// Two neighbouring readings around a time and how far between them it lies; both the same, and
/// share 0, where a reading has just that time.
struct Bracket {
  std::size_t before = 0;
  std::size_t after = 0;
  double share = 0.0;  ///< in [0, 1): of the way from `before` to `after`
};

/// The rising time stamps of a sensor.
class TimeLine {
 public:
  void add(std::int64_t time_ns) { times_ns_.push_back(time_ns); }
  std::int64_t at(std::size_t i) const { return times_ns_[i]; }
  std::size_t size() const { return times_ns_.size(); }
  void insert_first(std::int64_t time_ns) { times_ns_.insert(times_ns_.begin(), time_ns); }

  /// Nothing where the time is not covered: before the first, after the last, or in a gap wider
  /// than `max_gap_ns`.
  std::optional<Bracket> around(std::int64_t time_ns, std::int64_t max_gap_ns) const;

  /// "3 readings from 0 to 2000 ns".
  std::string text() const;

 private:
  std::vector<std::int64_t> times_ns_;
};

/// `altimeter0/data.csv`: time, altitude above the floor (m, > 0).
class AltitudeSeries {
 public:
  AltitudeSeries(const std::filesystem::path& csv, const SensorYaml& yaml);
  std::optional<double> at(std::int64_t time_ns, std::int64_t max_gap_ns) const;
  const TimeLine& times() const { return times_; }

 private:
  TimeLine times_;
  std::vector<double> altitudes_m_;
};

/// `odometry0/data.csv`: time, integrated pose in its own frame, the variances of x, y, θ of the
/// motion since the row before in that row's frame, and perhaps the covariances xy, xt, yt.
class OdometrySeries {
 public:
  /// Throws InputError on a covariance that is not positive definite; that of the first row belongs
  /// to no motion and is not looked at.
  OdometrySeries(const std::filesystem::path& csv, const SensorYaml& yaml);

  /// Steps over gaps become holes with the declared motion, and the times from `first_ns` to
  /// `last_ns` that no row covers. Nothing without `gaps.least_intervals`.
  void make_holes(const OdometryGaps& gaps, std::int64_t first_ns, std::int64_t last_ns);

  bool covers(std::int64_t time_ns, std::int64_t max_gap_ns) const;
  const TimeLine& times() const { return times_; }

  /// The motion between two covered times, from < to, in the frame of the first.
  UncertainPose motion(std::int64_t from_ns, std::int64_t to_ns) const;
  /// Whether one of its steps is a hole.
  bool has_hole(std::int64_t from_ns, std::int64_t to_ns) const;
  /// As it was read, but for the clock.
  RecordedOdometry recorded() const;

 private:
  TimeLine times_;
  std::vector<UncertainPose> steps_;  ///< since the row before; the first is empty
  std::vector<bool> is_hole_;         ///< of each step; empty: none is
  RecordedOdometry recorded_;         ///< without its holes
};

/// `state_groundtruth_estimate0/data.csv` of EuRoC: time, position, quaternion w x y z; further
/// columns are ignored.
class PoseSeries {
 public:
  explicit PoseSeries(const std::filesystem::path& csv);
  std::optional<Pose> at(std::int64_t time_ns, std::int64_t max_gap_ns) const;

 private:
  TimeLine times_;
  std::vector<Pose> poses_;
};

}  // namespace fathom

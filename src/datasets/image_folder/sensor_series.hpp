#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "fathom/datasets/odometry_gaps.hpp"
#include "fathom/geometry/covariance.hpp"
#include "kept_readings.hpp"
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
  const std::vector<std::int64_t>& all() const { return times_ns_; }
  void insert_first(std::int64_t time_ns) { times_ns_.insert(times_ns_.begin(), time_ns); }

  /// Nothing where the time is not covered: before the first, after the last, or in a gap wider
  /// than `max_gap_ns`.
  std::optional<Bracket> around(std::int64_t time_ns, std::int64_t max_gap_ns) const;

  /// "3 readings from 0 to 2000 ns".
  std::string text() const;

 private:
  std::vector<std::int64_t> times_ns_;
};

struct AltitudeAt {
  double altitude_m = 0.0;
  /// For want of a reading that was left out: 1 % of the altitude, or what readings around it
  /// differ by where that is more, and growing with the time without one; 0 where none was left
  /// out.
  double sigma_m = 0.0;
};

/// `altimeter0/data.csv`: time, altitude above the floor (m, > 0).
class AltitudeSeries {
 public:
  /// Readings that their neighbours contradict or that are not above the floor are left out, if
  /// there are five or more and most are above it; else, and where outliers are kept, one that is
  /// not above the floor is refused.
  AltitudeSeries(const std::filesystem::path& csv, const SensorYaml& yaml);
  /// `max_gap_ns` between readings, those that are left out among them.
  std::optional<AltitudeAt> at(std::int64_t time_ns, std::int64_t max_gap_ns) const;
  const TimeLine& times() const { return times_; }
  /// What was left out, or kept against its neighbours, if anything was.
  std::optional<std::string> remark() const;

 private:
  std::optional<AltitudeAt> at(std::int64_t time_ns, std::int64_t max_gap_ns,
                               const KeptReadings& of) const;

  TimeLine times_;
  std::vector<double> altitudes_m_;
  std::vector<std::size_t> lines_;
  KeptReadings plausible_;
  KeptReadings used_;
};

/// `odometry0/data.csv`: time, integrated pose in its own frame, the variances of x, y, θ of the
/// motion since the row before in that row's frame, and perhaps the covariances xy, xt, yt.
class OdometrySeries {
 public:
  /// Throws InputError on a covariance that is not positive definite; that of the first row belongs
  /// to no motion and is not looked at.
  OdometrySeries(const std::filesystem::path& csv, const SensorYaml& yaml);

  /// Single rows that jump out and back are moved to where the rows around them have them, or kept
  /// where the sensor's outliers are; a step
  /// to where odometry starts again, at the pose of the first row or by a jump faster than
  /// `speed_limit_m_s` and far faster than other steps, is marked as a hole. Nothing where there
  /// are many jumps. Says what it found; to be called before make_holes.
  std::vector<std::string> mend(double speed_limit_m_s);

  /// Steps that are marked become holes with the declared motion; with `gaps.least_intervals` also
  /// those over gaps, and the times from `first_ns` to `last_ns` that no row covers.
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
  void mark_gaps(double least_intervals, std::int64_t first_ns, std::int64_t last_ns);

  TimeLine times_;
  std::vector<UncertainPose> steps_;  ///< since the row before; the first is empty
  std::vector<bool> is_hole_;         ///< of each step; empty: none is
  RecordedOdometry recorded_;         ///< without its holes
  bool keeps_outliers_ = false;
  std::vector<std::size_t> lines_;  ///< of the rows
};

/// `state_groundtruth_estimate0/data.csv` of EuRoC: time, position, quaternion w x y z; further
/// columns are ignored.
class PoseSeries {
 public:
  PoseSeries(const std::filesystem::path& csv, std::int64_t time_offset_ns);
  std::optional<Pose> at(std::int64_t time_ns, std::int64_t max_gap_ns) const;

 private:
  TimeLine times_;
  std::vector<Pose> poses_;
};

}  // namespace fathom

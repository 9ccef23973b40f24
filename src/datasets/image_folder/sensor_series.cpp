#include "sensor_series.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>

#include "fathom/core/text.hpp"
#include "fathom/datasets/series_outliers.hpp"
#include "fathom/geometry/quaternion_order.hpp"
#include "fathom/geometry/trajectory_file.hpp"
#include "sensor_csv.hpp"
#include "sensor_outliers.hpp"

namespace fathom {
namespace {

constexpr std::int64_t kAnyGap = std::numeric_limits<std::int64_t>::max();

// A share of a motion, at constant velocity in the axes it is given in.
Pose scaled(const Pose& motion, double share) {
  return {motion.x * share, motion.y * share, motion.theta * share};
}

SpatialPose spatial_pose(const SensorCsv& csv, const SensorRow& row) {
  // Height is not used, and need be none.
  const double z_m = parse_real(row.fields[3]).value_or(0.0);
  const Eigen::Vector3d position_m(csv.real(row, 1), csv.real(row, 2), z_m);
  const Eigen::Quaterniond rotation(csv.real(row, 4), csv.real(row, 5), csv.real(row, 6),
                                    csv.real(row, 7));
  if (std::abs(rotation.squaredNorm() - 1.0) > 0.02) {
    csv.refuse(row, "the quaternion has not length one; its order is q_w, q_x, q_y, q_z");
  }
  return {position_m, rotation};
}

Eigen::Matrix3d step_covariance(const SensorCsv& csv, const SensorRow& row) {
  Eigen::Matrix3d C =
      Eigen::Vector3d(csv.real(row, 4), csv.real(row, 5), csv.real(row, 6)).asDiagonal();
  if (row.fields.size() >= 10) {
    C(0, 1) = C(1, 0) = csv.real(row, 7);
    C(0, 2) = C(2, 0) = csv.real(row, 8);
    C(1, 2) = C(2, 1) = csv.real(row, 9);
  }
  return C;
}

}  // namespace

std::optional<Bracket> TimeLine::around(std::int64_t time_ns, std::int64_t max_gap_ns) const {
  const auto after = std::ranges::lower_bound(times_ns_, time_ns);
  if (after == times_ns_.end()) return std::nullopt;
  const auto index = static_cast<std::size_t>(after - times_ns_.begin());
  if (*after == time_ns) return Bracket{index, index, 0.0};
  if (index == 0) return std::nullopt;
  const std::int64_t gap_ns = *after - times_ns_[index - 1];
  if (gap_ns > max_gap_ns) return std::nullopt;
  const auto since_ns = static_cast<double>(time_ns - times_ns_[index - 1]);
  return Bracket{index - 1, index, since_ns / static_cast<double>(gap_ns)};
}

std::string TimeLine::text() const {
  return fmt::format("{} readings from {} to {} ns", times_ns_.size(), times_ns_.front(),
                     times_ns_.back());
}

AltitudeSeries::AltitudeSeries(const std::filesystem::path& path, const SensorYaml& yaml) {
  const SensorCsv csv(path, "timestamp, altitude", "", yaml.time_offset_ns);
  std::vector<const SensorRow*> not_above;
  for (const SensorRow& row : csv.rows()) {
    times_.add(row.time_ns);
    altitudes_m_.push_back(yaml.scale * csv.real(row, 1));
    lines_.push_back(row.line);
    if (!(altitudes_m_.back() > 0.0)) not_above.push_back(&row);
  }
  const std::size_t count = altitudes_m_.size();
  const bool are_few = count >= OutlierLimits().least_readings && 2 * not_above.size() < count;
  if (!not_above.empty() && (yaml.keeps_outliers || !are_few)) {
    const SensorRow& row = *not_above.front();
    csv.refuse(row, "altitude " + row.fields[1] + " is not above the floor; expected metres > 0");
  }
  plausible_ = KeptReadings(plausible_altitudes(times_.all(), altitudes_m_));
  used_ = yaml.keeps_outliers ? KeptReadings(std::vector<bool>(count, true)) : plausible_;
}

std::optional<AltitudeAt> AltitudeSeries::at(std::int64_t time_ns, std::int64_t max_gap_ns) const {
  return at(time_ns, max_gap_ns, used_);
}

std::optional<AltitudeAt> AltitudeSeries::at(std::int64_t time_ns, std::int64_t max_gap_ns,
                                             const KeptReadings& of) const {
  const auto in_all = times_.around(time_ns, max_gap_ns);
  if (!in_all) return std::nullopt;
  const auto [bracket, growth] = filling(times_, of, *in_all, time_ns);
  AltitudeAt found;
  found.altitude_m =
      std::lerp(altitudes_m_[bracket.before], altitudes_m_[bracket.after], bracket.share);
  if (growth == 0.0) return found;
  // Relief between readings is seldom less.
  constexpr double kLeastShare = 0.01;
  const double spread_m =
      spread_around(bracket, of, [this](std::size_t i) { return altitudes_m_[i]; });
  found.sigma_m = growth * std::max(spread_m, kLeastShare * found.altitude_m);
  return found;
}

std::optional<std::string> AltitudeSeries::remark() const {
  const auto first = first_outlier(plausible_.all());
  if (!first) return std::nullopt;
  const double expected_m = at(times_.at(*first), 0, plausible_).value().altitude_m;
  return outlier_remark("altimeter0", plausible_.all(), lines_[*first],
                        fmt::format("{} m where its neighbours have {} m",
                                    short_number(altitudes_m_[*first]), short_number(expected_m)),
                        used_[*first]);
}

OdometrySeries::OdometrySeries(const std::filesystem::path& path, const SensorYaml& yaml) {
  const SensorCsv csv(path, "timestamp, p_x, p_y, theta, step_var_x, step_var_y, step_var_theta",
                      "step_cov_xy, step_cov_xt, step_cov_yt", yaml.time_offset_ns);
  keeps_outliers_ = yaml.keeps_outliers;
  recorded_.format = yaml.odometry;
  recorded_.time_offset_s = 1e-9 * static_cast<double>(yaml.time_offset_ns);
  Pose last;
  for (const SensorRow& row : csv.rows()) {
    const ReckonedRow read{row.time_ns, csv.real(row, 1), csv.real(row, 2), csv.real(row, 3),
                           false};
    const Pose pose = yaml.odometry.pose(read);
    const Eigen::Matrix3d covariance = yaml.odometry.covariance(step_covariance(csv, row));
    const bool first = steps_.empty();
    if (!first && !is_positive_definite(covariance)) {
      csv.refuse(row,
                 "the covariance of the step is not positive definite; expected variances > 0 "
                 "and correlations between -1 and 1");
    }
    times_.add(row.time_ns);
    lines_.push_back(row.line);
    steps_.push_back(first ? UncertainPose{} : UncertainPose{between(last, pose), covariance});
    last = pose;
    recorded_.rows.push_back(read);
  }
}

bool OdometrySeries::covers(std::int64_t time_ns, std::int64_t max_gap_ns) const {
  if (times_.around(time_ns, max_gap_ns)) return true;
  const auto bracket = times_.around(time_ns, kAnyGap);
  return bracket && !is_hole_.empty() && is_hole_[bracket->after];
}

void OdometrySeries::make_holes(const OdometryGaps& gaps, std::int64_t first_ns,
                                std::int64_t last_ns) {
  if (gaps.least_intervals) mark_gaps(*gaps.least_intervals, first_ns, last_ns);
  for (std::size_t row = 1; row < is_hole_.size(); ++row) {
    if (!is_hole_[row]) continue;
    constexpr double kSeconds = 1e-9;
    const auto duration_ns = static_cast<double>(times_.at(row) - times_.at(row - 1));
    steps_[row] = gaps.declared.motion(duration_ns * kSeconds);
  }
}

void OdometrySeries::mark_gaps(double least_intervals, std::int64_t first_ns,
                               std::int64_t last_ns) {
  is_hole_.resize(steps_.size(), false);
  if (steps_.size() > 1) {
    std::vector<std::int64_t> intervals_ns;
    for (std::size_t row = 1; row < steps_.size(); ++row) {
      intervals_ns.push_back(times_.at(row) - times_.at(row - 1));
    }
    std::vector<std::int64_t> sorted = intervals_ns;
    std::ranges::sort(sorted);
    const double least_ns = least_intervals * static_cast<double>(sorted[sorted.size() / 2]);
    for (std::size_t row = 1; row < steps_.size(); ++row) {
      if (static_cast<double>(intervals_ns[row - 1]) >= least_ns) is_hole_[row] = true;
    }
  }
  if (first_ns < times_.at(0)) {
    times_.insert_first(first_ns);
    steps_.insert(steps_.begin(), UncertainPose{});
    is_hole_.insert(is_hole_.begin(), false);
    is_hole_[1] = true;
  }
  if (last_ns > times_.at(times_.size() - 1)) {
    times_.add(last_ns);
    steps_.emplace_back();
    is_hole_.push_back(true);
  }
}

bool OdometrySeries::has_hole(std::int64_t from_ns, std::int64_t to_ns) const {
  if (is_hole_.empty()) return false;
  const Bracket from = times_.around(from_ns, kAnyGap).value();
  const Bracket to = times_.around(to_ns, kAnyGap).value();
  const auto step = [this](std::size_t row) {
    return is_hole_.begin() + static_cast<std::ptrdiff_t>(row);
  };
  return std::find(step(from.before + 1), step(to.after + 1), true) != step(to.after + 1);
}

RecordedOdometry OdometrySeries::recorded() const {
  RecordedOdometry recorded = recorded_;
  // A hole may begin before the first reading.
  const std::size_t before = times_.at(0) < recorded.rows.front().time_ns ? 1 : 0;
  for (std::size_t row = 1; row < recorded.rows.size() && !is_hole_.empty(); ++row) {
    recorded.rows[row].is_after_hole = is_hole_[row + before];
  }
  return recorded;
}

UncertainPose OdometrySeries::motion(std::int64_t from_ns, std::int64_t to_ns) const {
  const Bracket from = times_.around(from_ns, kAnyGap).value();
  const Bracket to = times_.around(to_ns, kAnyGap).value();
  // Step r leads from row r − 1 to row r; the first one cut is that after `from.before`.
  std::vector<UncertainPose> parts;
  for (std::size_t row = from.before + 1; row <= to.after; ++row) {
    const double start = row == from.before + 1 ? from.share : 0.0;
    const double end = row == to.after && to.share > 0.0 ? to.share : 1.0;
    parts.push_back(part_of(steps_[row], start, end));
  }
  return compose_chain(parts);
}

PoseSeries::PoseSeries(const std::filesystem::path& path, std::int64_t time_offset_ns) {
  const SensorCsv csv(path, "timestamp, p_x, p_y, p_z, q_w, q_x, q_y, q_z", "", time_offset_ns);
  std::vector<StampedSpatialPose> in_space;
  for (const SensorRow& row : csv.rows()) {
    in_space.push_back({row.time_ns, spatial_pose(csv, row)});
    const SpatialPose& pose = in_space.back().pose;
    times_.add(row.time_ns);
    poses_.push_back({pose.position_m.x(), pose.position_m.y(), yaw_of(pose.rotation)});
  }
  require_order(in_space, TrajectoryFormat::euroc, path.string());
}

std::optional<Pose> PoseSeries::at(std::int64_t time_ns, std::int64_t max_gap_ns) const {
  const auto bracket = times_.around(time_ns, max_gap_ns);
  if (!bracket) return std::nullopt;
  const Pose& before = poses_[bracket->before];
  if (bracket->share == 0.0) return before;
  return compose(before, scaled(between(before, poses_[bracket->after]), bracket->share));
}

}  // namespace fathom

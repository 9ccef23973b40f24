#include "reading_outliers.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>

#include "fathom/core/text.hpp"
#include "fathom/datasets/series_outliers.hpp"
#include "sensor_outliers.hpp"

namespace fathom {
namespace {

constexpr double kAllowedHeading_rad = 1.0;
constexpr double kAllowedFix_m = 1.0;
constexpr double kAllowedReadingSigmas = 10.0;

/// Dead reckoning at the time of a reading.
struct ReckonedReading {
  Pose pose;
  /// How many holes lie before it; nothing within one.
  std::optional<std::size_t> stretch;
};

// At rising times, each between the first frame and the last one.
std::vector<ReckonedReading> reckoned_at(const std::vector<std::int64_t>& times_ns,
                                         const std::vector<FrameInfo>& frames) {
  std::vector<ReckonedReading> readings;
  Pose pose;
  std::size_t stretch = 0;
  std::size_t i = 0;
  for (const std::int64_t time_ns : times_ns) {
    for (; i + 1 < frames.size() && frames[i + 1].time_ns <= time_ns; ++i) {
      pose = compose(pose, frames[i + 1].motion->mean);
      stretch += frames[i + 1].is_hole ? 1 : 0;
    }
    readings.push_back({pose, stretch});
    if (frames[i].time_ns == time_ns || i + 1 == frames.size()) continue;
    const Pose& motion = frames[i + 1].motion->mean;
    const double share = static_cast<double>(time_ns - frames[i].time_ns) /
                         static_cast<double>(frames[i + 1].time_ns - frames[i].time_ns);
    readings.back().pose =
        compose(pose, {share * motion.x, share * motion.y, share * motion.theta});
    if (frames[i + 1].is_hole) readings.back().stretch.reset();
  }
  return readings;
}

bool is_over_hole(const ReckonedReading& a, const ReckonedReading& b) {
  return !a.stretch || !b.stretch || *a.stretch != *b.stretch;
}

/// Readings to be judged; without odometry `reckoned` is empty.
struct Judged {
  std::vector<std::int64_t> times_ns;
  std::vector<ReckonedReading> reckoned;

  template <class Readings>
  Judged(const Readings& readings, const std::vector<FrameInfo>& frames) {
    for (const auto& reading : readings) times_ns.push_back(reading.time_ns);
    if (frames.size() > 1 && frames[1].motion) reckoned = reckoned_at(times_ns, frames);
  }
};

// The nearest kept reading before i, else after it.
std::size_t kept_neighbour(const std::vector<bool>& kept, std::size_t i) {
  for (std::size_t j = i; j-- > 0;) {
    if (kept[j]) return j;
  }
  return static_cast<std::size_t>(
      std::find(kept.begin() + static_cast<std::ptrdiff_t>(i), kept.end(), true) - kept.begin());
}

template <class Item>
void keep_only(std::vector<Item>& items, const std::vector<bool>& kept) {
  std::size_t i = 0;
  std::erase_if(items, [&](const Item&) { return !kept[i++]; });
}

std::optional<std::string> leave_out_headings(FolderCompass& compass,
                                              const std::vector<FrameInfo>& frames) {
  const std::vector<MeasuredHeading>& readings = compass.readings;
  const Judged judged(readings, frames);
  const double sense = compass.is_from_north ? -1.0 : 1.0;
  const auto turned = [&](std::size_t i, std::size_t j) {
    return wrap_angle(sense * (readings[j].heading_rad - readings[i].heading_rad));
  };
  const auto allowed = [&](std::size_t i, std::size_t j) {
    return std::max(kAllowedHeading_rad, kAllowedReadingSigmas * std::hypot(readings[i].sigma_rad,
                                                                            readings[j].sigma_rad));
  };
  const auto alone = [&](std::size_t i, std::size_t j) { return std::abs(turned(i, j)); };
  const auto carried = [&](std::size_t i, std::size_t j) {
    const ReckonedReading& a = judged.reckoned[i];
    const ReckonedReading& b = judged.reckoned[j];
    if (is_over_hole(a, b)) return 0.0;
    return std::abs(wrap_angle(turned(i, j) - (b.pose.theta - a.pose.theta)));
  };
  std::vector<bool> kept = kept_readings({judged.times_ns, alone, allowed});
  if (!judged.reckoned.empty()) {
    const std::vector<bool> kept_carried = kept_readings({judged.times_ns, carried, allowed});
    for (std::size_t i = 0; i < kept.size(); ++i) kept[i] = kept[i] || kept_carried[i];
  }
  const auto first = first_outlier(kept);
  if (!first) return std::nullopt;
  const double off_rad = alone(kept_neighbour(kept, *first), *first);
  std::string remark = outlier_remark("compass0", kept, compass.lines[*first],
                                      short_number(off_rad) + " rad from the heading beside it",
                                      compass.keeps_outliers);
  if (!compass.keeps_outliers) keep_only(compass.readings, kept);
  return remark;
}

// In metres, of fixes that are near each other.
Eigen::Vector2d motion_of(const PositionFix& from, const PositionFix& to) {
  return to.position_m - from.position_m;
}

Eigen::Vector2d motion_of(const EarthFix& from, const EarthFix& to) {
  constexpr double kRadius_m = 6371000.0;
  constexpr double kDegree = std::numbers::pi / 180.0;
  const double east = wrap_angle(kDegree * (to.longitude_deg - from.longitude_deg));
  return kRadius_m * Eigen::Vector2d(kDegree * (to.latitude_deg - from.latitude_deg),
                                     std::cos(kDegree * from.latitude_deg) * east);
}

template <class Fix>
std::optional<std::string> leave_out_fixes(FolderFixes& of, std::vector<Fix>& fixes,
                                           const std::vector<FrameInfo>& frames) {
  if (fixes.empty()) return std::nullopt;
  const Judged judged(fixes, frames);
  const auto apart = [&](std::size_t i, std::size_t j) {
    const double moved_m = motion_of(fixes[i], fixes[j]).norm();
    if (judged.reckoned.empty()) return moved_m;
    const ReckonedReading& a = judged.reckoned[i];
    const ReckonedReading& b = judged.reckoned[j];
    if (is_over_hole(a, b)) return 0.0;
    // Of the antenna; a distance, as nobody knows how dead reckoning lies in the world.
    const Eigen::Vector2d way = transform(b.pose, of.lever_m) - transform(a.pose, of.lever_m);
    return std::abs(moved_m - way.norm());
  };
  const auto allowed = [&](std::size_t i, std::size_t j) {
    const double variance = fixes[i].covariance.trace() + fixes[j].covariance.trace();
    return std::max(kAllowedFix_m, kAllowedReadingSigmas * std::sqrt(variance));
  };
  const std::vector<bool> kept = kept_readings({judged.times_ns, apart, allowed});
  const auto first = first_outlier(kept);
  if (!first) return std::nullopt;
  const std::size_t beside = kept_neighbour(kept, *first);
  std::string remark = outlier_remark(
      "position0", kept, of.lines[*first],
      short_number(motion_of(fixes[beside], fixes[*first]).norm()) + " m from the fix beside it",
      of.keeps_outliers);
  if (!of.keeps_outliers) keep_only(fixes, kept);
  return remark;
}

}  // namespace

std::vector<std::string> leave_out_contradicted(FolderSensors& sensors,
                                                const std::vector<FrameInfo>& frames) {
  std::vector<std::string> remarks;
  const auto add = [&remarks](std::optional<std::string> remark) {
    if (remark) remarks.push_back(std::move(*remark));
  };
  if (sensors.compass) add(leave_out_headings(*sensors.compass, frames));
  if (sensors.fixes) {
    add(leave_out_fixes(*sensors.fixes, sensors.fixes->in_world, frames));
    add(leave_out_fixes(*sensors.fixes, sensors.fixes->on_earth, frames));
  }
  return remarks;
}

}  // namespace fathom

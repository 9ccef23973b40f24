#include "fathom/datasets/sensor_summary.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

#include "fathom/core/median.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

double seconds(std::int64_t from_ns, std::int64_t to_ns) {
  return 1e-9 * static_cast<double>(to_ns - from_ns);
}

std::string count(std::size_t number, const std::string& what, const std::string& plural) {
  return fmt::format("{} {}", number, number == 1 ? what : plural);
}

// ", one in 2 s"; nothing of a single reading.
template <class Reading>
std::string interval_text(const std::vector<Reading>& readings) {
  if (readings.size() < 2) return "";
  const double span_s = seconds(readings.front().time_ns, readings.back().time_ns);
  return ", one in " + short_number(span_s / static_cast<double>(readings.size() - 1)) + " s";
}

template <class Fix>
void sum_up_fixes(const std::vector<Fix>& fixes, const std::string& frame,
                  const Eigen::Vector2d& lever_m, FolderSummary& summary) {
  if (fixes.empty()) return;
  std::vector<double> sigmas_m;
  sigmas_m.reserve(fixes.size());
  for (const Fix& fix : fixes) sigmas_m.push_back(std::sqrt(0.5 * fix.covariance.trace()));
  summary.facts.push_back(fmt::format("fixes: {} in {}{}, median sigma {} m, antenna at {}, {} m",
                                      fixes.size(), frame, interval_text(fixes),
                                      short_number(upper_median(sigmas_m)),
                                      short_number(lever_m.x()), short_number(lever_m.y())));
}

void sum_up_compass(const FolderCompass& compass, FolderSummary& summary) {
  std::vector<double> sigmas_deg;
  for (const MeasuredHeading& reading : compass.readings) {
    sigmas_deg.push_back(reading.sigma_rad * kDegrees);
  }
  summary.facts.push_back(
      fmt::format("compass: {}{}{}, median sigma {} degrees, mounting yaw {} rad",
                  count(compass.readings.size(), "heading", "headings"),
                  compass.is_from_north ? " from north" : "", interval_text(compass.readings),
                  short_number(upper_median(sigmas_deg)), short_number(compass.mount_yaw_rad)));
  if (compass.left_out > 0) {
    summary.facts.push_back("compass: " + count(compass.left_out, "heading", "headings") +
                            " outside the time of the pictures, left out");
  }
  constexpr double kVaguest_deg = 45.0;
  if (upper_median(sigmas_deg) > kVaguest_deg) {
    summary.warnings.emplace_back(
        "headings of compass0 are known to no better than 45 degrees; is sigma in radians?");
  }
}

}  // namespace

void sum_up_sensors(const FolderSensors& sensors, FolderSummary& summary) {
  if (sensors.compass) sum_up_compass(*sensors.compass, summary);
  if (!sensors.fixes) return;
  const FolderFixes& fixes = *sensors.fixes;
  sum_up_fixes(fixes.in_world, "x and y", fixes.lever_m, summary);
  sum_up_fixes(fixes.on_earth, "latitude and longitude", fixes.lever_m, summary);
}

void sum_up_holes(const FrameSource& source, const FrameSource* plain, FolderSummary& summary) {
  std::size_t holes = 0;
  double longest_s = 0.0;
  bool are_gaps = false;
  for (std::size_t i = 1, first = 0; i < source.size(); ++i) {
    if (!source.info(i).is_hole) continue;
    are_gaps = are_gaps || plain == nullptr || !plain->info(i).is_hole;
    if (!source.info(i - 1).is_hole) {
      ++holes;
      first = i - 1;
    }
    longest_s = std::max(longest_s, seconds(source.info(first).time_ns, source.info(i).time_ns));
  }
  if (holes == 0) return;
  summary.facts.push_back(fmt::format("odometry: {}, the longest over {} s of pictures",
                                      count(holes, "hole", "holes"), short_number(longest_s)));
  if (!are_gaps) return;
  summary.warnings.emplace_back(
      "odometry0 stops where five of its intervals or more are missing: dataset.gap_intervals: 5 "
      "takes that for holes; without it, it is divided evenly, or refused where a picture lies in "
      "more than 2 s of it");
}

}  // namespace fathom

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "findings.hpp"

namespace fathom {
namespace {

struct StampedHeading {
  std::int64_t time_ns = 0;
  double heading_rad = 0.0;
};

// How far dead reckoning turns while headings are one and the same; 0 where they are not.
double turn_of_still(const std::vector<StampedHeading>& headings, const OdometryTrack& track) {
  constexpr double kStill_rad = 1e-3;  // less than the noise of any compass
  double turned_rad = 0.0;
  for (const StampedHeading& heading : headings) {
    const StampedHeading& first = headings.front();
    if (std::abs(wrap_angle(heading.heading_rad - first.heading_rad)) > kStill_rad) return 0.0;
    const auto motion = track.motion(first.time_ns, heading.time_ns);
    if (motion) turned_rad = std::max(turned_rad, std::abs(motion->theta));
  }
  return turned_rad;
}

}  // namespace

void find_still_headings(const CalibrationInput& input, const OdometryTrack& track,
                         std::vector<std::string>& findings) {
  constexpr double kTurned_rad = 0.5;
  std::vector<StampedHeading> of_compass;
  for (const MeasuredHeading& one : input.readings.headings) {
    of_compass.push_back({one.time_ns, one.heading_rad});
  }
  if (const double turned_rad = turn_of_still(of_compass, track); turned_rad > kTurned_rad) {
    findings.push_back(fmt::format(
        "compass0 says {} rad in each of its {} headings while odometry0 turns by {} rad: "
        "it measures nothing; remove its folder, or write "
        "'dataset.compass.use: false'",
        short_number(of_compass.front().heading_rad), of_compass.size(), short_number(turned_rad)));
  }
  std::vector<StampedHeading> of_truth;
  for (const StampedPose& one : input.references) of_truth.push_back({one.time_ns, one.pose.theta});
  if (const double turned_rad = turn_of_still(of_truth, track); turned_rad > kTurned_rad) {
    findings.push_back(fmt::format(
        "ground truth has heading {} rad in each of its {} poses while odometry0 turns by {} rad: "
        "it measures positions alone. Heading errors, NEES and NIS against it mean nothing, and "
        "errors of position need 'evaluation.alignment: se2'; write its headings",
        short_number(of_truth.front().heading_rad), of_truth.size(), short_number(turned_rad)));
  }
}

bool find_still_odometry(const CalibrationInput& input, std::vector<std::string>& findings) {
  constexpr double kStill_rad = 1e-6;
  constexpr double kTurned_rad = 1.0;
  const std::vector<ReckonedRow>& rows = input.odometry.rows;
  if (input.is_visual_odometry || rows.size() < 2) return false;
  for (const ReckonedRow& row : rows) {
    if (std::abs(row.heading_rad - rows.front().heading_rad) > kStill_rad) return false;
  }
  double turned_rad = 0.0;
  double largest_rad = 0.0;
  for (const SeenMotion& motion : input.motions) {
    turned_rad += motion.camera.theta;
    largest_rad = std::max(largest_rad, std::abs(turned_rad));
  }
  if (largest_rad < kTurned_rad) return false;
  findings.push_back(
      fmt::format("odometry0 has heading {} rad in each of its {} rows while the pictures turn by "
                  "{} rad: it measures none; write its headings, or remove its folder, and the "
                  "motions are made of the pictures",
                  short_number(rows.front().heading_rad), rows.size(), short_number(largest_rad)));
  return true;
}

}  // namespace fathom

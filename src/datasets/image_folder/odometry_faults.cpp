// Rows of odometry0 that cannot be: single ones that jump out and back, and where it starts again.

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <functional>
#include <utility>

#include "fathom/core/text.hpp"
#include "kept_readings.hpp"
#include "sensor_outliers.hpp"
#include "sensor_series.hpp"

namespace fathom {
namespace {

// A jump is so many times as fast as what four steps in five stay below, and as its neighbours.
constexpr double kTimesFaster = 5.0;
constexpr double kOrdinaryShare = 0.8;
// A step to the pose of the first row is so many times as long as its neighbours.
constexpr double kTimesFurther = 2.0;
constexpr double kStatedSigmas = 10.0;
// Of fewer steps nobody knows how fast the vehicle is.
constexpr std::size_t kLeastSteps = 5;
// More jumps than that are no faults of single rows.
constexpr std::size_t kMostJumps = 3;
constexpr std::size_t kStepsPerJump = 20;

/// Steps of odometry, from row r − 1 to row r; r = 0 has none.
class OdometrySteps {
 public:
  OdometrySteps(const TimeLine& times, const std::vector<UncertainPose>& steps,
                double speed_limit_m_s)
      : steps_(steps) {
    for (const UncertainPose& step : steps) {
      poses_.push_back(poses_.empty() ? Pose{} : compose(poses_.back(), step.mean));
    }
    std::vector<double> speeds_m_s{0.0};  // row 0 has no step
    for (std::size_t r = 1; r < steps.size(); ++r) {
      const double duration_s = 1e-9 * static_cast<double>(times.at(r) - times.at(r - 1));
      speeds_m_s.push_back(length_m(r) / duration_s);
    }
    std::vector<double> sorted(speeds_m_s.begin() + 1, speeds_m_s.end());
    const auto ordinary =
        sorted.begin() +
        static_cast<std::ptrdiff_t>(kOrdinaryShare * static_cast<double>(sorted.size() - 1));
    std::nth_element(sorted.begin(), ordinary, sorted.end());
    const double least_m_s = std::max(speed_limit_m_s, kTimesFaster * *ordinary);
    for (const double speed_m_s : speeds_m_s) is_fast_.push_back(speed_m_s > least_m_s);
    std::vector<bool> is_slow = is_fast_;
    is_slow.flip();
    is_slow[0] = false;
    slow_ = KeptReadings(std::move(is_slow));
    for (const UncertainPose& step : steps) turns_rad_.push_back(std::abs(step.mean.theta));
    std::ranges::partial_sort(turns_rad_, turns_rad_.begin() + 2, std::greater<>());
    turns_rad_.resize(2);
  }

  /// Whether step r is fast, and the steps around it are not: more in a row are a fast vehicle.
  bool is_jump(std::size_t r) const {
    return is_fast_[r] && !is_fast(r - 1) && !is_fast(r + 1) && is_beyond_neighbours(r);
  }

  /// Whether row r alone is elsewhere: the rows around it are as near as rows are.
  bool is_spike(std::size_t r) const {
    if (!is_fast(r) || !is_fast(r + 1) || is_fast(r - 1) || is_fast(r + 2)) return false;
    const double left_m = between(poses_[r - 1], poses_[r + 1]).position().norm();
    return is_beyond_neighbours(r) &&
           left_m <= kTimesFaster * near_m(r) + kStatedSigmas * sigma_m(r);
  }

  /// Whether row r is at the pose of the first row, by no way that its neighbours would go.
  bool is_at_start_again(std::size_t r) const {
    if (r < 2 || !is_start(r) || is_start(r - 1)) return false;
    const double turn_rad = std::abs(steps_[r].mean.theta);
    constexpr double kLeast_m = 0.05;
    constexpr double kLeast_rad = 0.1;
    if (length_m(r) > std::max({kLeast_m, kStatedSigmas * sigma_m(r), kTimesFurther * near_m(r)})) {
      return true;
    }
    const double sigma_rad = std::sqrt(steps_[r].covariance(2, 2));
    const double other_rad = turn_rad == turns_rad_[0] ? turns_rad_[1] : turns_rad_[0];
    return turn_rad > std::max(kLeast_rad, kStatedSigmas * sigma_rad) &&
           kTimesFurther * other_rad < turn_rad;
  }

 private:
  double length_m(std::size_t r) const { return steps_[r].mean.position().norm(); }
  double sigma_m(std::size_t r) const {
    return std::sqrt(steps_[r].covariance.topLeftCorner<2, 2>().trace());
  }

  // Poses are composed again, so with what that rounds off.
  bool is_start(std::size_t r) const {
    constexpr double kRounded = 1e-6;
    return poses_[r].position().norm() < kRounded && std::abs(poses_[r].theta) < kRounded;
  }

  bool is_fast(std::size_t r) const { return r < is_fast_.size() && is_fast_[r]; }
  bool is_beyond_neighbours(std::size_t r) const { return length_m(r) > kTimesFaster * near_m(r); }

  // The longest of the two nearest steps on either side that are not fast.
  double near_m(std::size_t r) const {
    double most = 0.0;
    for (const std::size_t nth : {0U, 1U}) {
      if (const auto i = slow_.before(r - 1, nth)) most = std::max(most, length_m(*i));
      if (const auto i = slow_.after(r + 1, nth)) most = std::max(most, length_m(*i));
    }
    return most;
  }

  const std::vector<UncertainPose>& steps_;
  std::vector<Pose> poses_;  ///< in the frame of the first
  std::vector<bool> is_fast_;
  KeptReadings slow_;              ///< steps that are not fast
  std::vector<double> turns_rad_;  ///< the two largest of any step
};

struct OdometryFaults {
  std::vector<std::size_t> spikes;
  std::vector<std::size_t> restarts;
};

OdometryFaults find_faults(const OdometrySteps& steps, std::size_t rows) {
  OdometryFaults faults;
  for (std::size_t r = 1; r < rows; ++r) {
    if (steps.is_spike(r)) {
      faults.spikes.push_back(r++);
    } else if (steps.is_jump(r) || steps.is_at_start_again(r)) {
      faults.restarts.push_back(r);
    }
  }
  const std::size_t most = std::max(kMostJumps, (rows - 1) / kStepsPerJump);
  if (faults.spikes.size() + faults.restarts.size() > most) return {};
  return faults;
}

}  // namespace

std::vector<std::string> OdometrySeries::mend(double speed_limit_m_s) {
  if (steps_.size() < kLeastSteps + 1) return {};
  const OdometryFaults faults =
      find_faults(OdometrySteps(times_, steps_, speed_limit_m_s), steps_.size());
  std::vector<std::string> remarks;
  if (!faults.spikes.empty()) {
    std::vector<bool> kept(steps_.size(), true);
    for (const std::size_t r : faults.spikes) kept[r] = false;
    const std::size_t first = faults.spikes.front();
    remarks.push_back(
        outlier_remark("odometry0", kept, lines_[first],
                       fmt::format("{} m from the row before, and back",
                                   short_number(steps_[first].mean.position().norm())),
                       keeps_outliers_));
  }
  for (const std::size_t r : faults.spikes) {
    if (keeps_outliers_) break;
    const Pose over = compose(steps_[r].mean, steps_[r + 1].mean);
    const double share = static_cast<double>(times_.at(r) - times_.at(r - 1)) /
                         static_cast<double>(times_.at(r + 1) - times_.at(r - 1));
    steps_[r].mean = {share * over.x, share * over.y, share * over.theta};
    steps_[r + 1].mean = between(steps_[r].mean, over);
  }
  for (const std::size_t r : faults.restarts) {
    remarks.push_back(fmt::format(
        "odometry0 starts again at line {} (t = {} ns), {} m away: the motion there is a hole",
        lines_[r], times_.at(r), short_number(steps_[r].mean.position().norm())));
    is_hole_.resize(steps_.size(), false);
    is_hole_[r] = true;
  }
  return remarks;
}

}  // namespace fathom

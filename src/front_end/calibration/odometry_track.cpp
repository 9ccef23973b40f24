#include "odometry_track.hpp"

#include <algorithm>
#include <cmath>

namespace fathom {

OdometryTrack::OdometryTrack(const RecordedOdometry& odometry, const OdometryFormat& format,
                             double offset_s) {
  const std::int64_t shift_ns = nanoseconds(offset_s);
  std::size_t holes = 0;
  for (const ReckonedRow& row : odometry.rows) {
    times_ns_.push_back(row.time_ns + shift_ns);
    poses_.push_back(format.pose(row));
    holes_.push_back(holes += row.is_after_hole ? 1 : 0);
  }
}

std::optional<OdometryTrack::Place> OdometryTrack::at(std::int64_t time_ns) const {
  const auto after = std::ranges::lower_bound(times_ns_, time_ns);
  if (after == times_ns_.end()) return std::nullopt;
  const auto row = static_cast<std::size_t>(after - times_ns_.begin());
  if (*after == time_ns) return Place{poses_[row], holes_[row], false};
  if (row == 0) return std::nullopt;
  const double share = static_cast<double>(time_ns - times_ns_[row - 1]) /
                       static_cast<double>(*after - times_ns_[row - 1]);
  const Pose step = between(poses_[row - 1], poses_[row]);
  return Place{compose(poses_[row - 1], {share * step.x, share * step.y, share * step.theta}),
               holes_[row], holes_[row] != holes_[row - 1]};
}

std::optional<Pose> OdometryTrack::motion(std::int64_t from_ns, std::int64_t to_ns) const {
  const auto from = at(from_ns);
  const auto to = at(to_ns);
  if (!from || !to || from->holes != to->holes || from->is_in_hole || to->is_in_hole) {
    return std::nullopt;
  }
  return between(from->pose, to->pose);
}

}  // namespace fathom

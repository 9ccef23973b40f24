#include "fathom/geometry/keyframe_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {
namespace {

// Counted from the first: beyond a thousand million cells from the origin all share the outermost.
constexpr double kOutermost = 1e9;
constexpr std::uint64_t kNoCell = std::numeric_limits<std::uint64_t>::max();

std::uint64_t joined(std::uint32_t column, std::uint32_t row) {
  return std::uint64_t{column} << 32U | row;
}

}  // namespace

std::uint32_t KeyframeGrid::along(double coordinate_m) const {
  const double cell = std::floor(coordinate_m / cell_m_);
  return static_cast<std::uint32_t>(kOutermost + std::clamp(cell, -kOutermost, kOutermost));
}

KeyframeGrid::Cell KeyframeGrid::cell_of(const Pose& pose) const {
  if (!std::isfinite(pose.x) || !std::isfinite(pose.y)) return kNoCell;
  return joined(along(pose.x), along(pose.y));
}

void KeyframeGrid::place(std::size_t keyframe, const Pose& pose) {
  const Cell cell = cell_of(pose);
  Cell& held = cells_[keyframe];
  if (cell == held) return;
  if (held != kNoCell) {
    const auto left = keyframes_.find(held);
    std::erase(left->second, keyframe);
    if (left->second.empty()) keyframes_.erase(left);
  }
  if (cell != kNoCell) keyframes_[cell].push_back(static_cast<std::uint32_t>(keyframe));
  held = cell;
}

void KeyframeGrid::follow(const TrajectoryView& trajectory) {
  if (&trajectory != trajectory_ || trajectory.size() < cells_.size()) {
    trajectory_ = &trajectory;
    revision_ = 0;
    keyframes_.clear();
    cells_.clear();
  }
  cells_.resize(trajectory.size(), kNoCell);
  const MovedPoses moved = trajectory.moved_since(revision_);
  revision_ = moved.revision;
  for (const std::size_t k : moved.keyframes.value_or(consecutive(0, cells_.size()))) {
    place(k, trajectory.pose(k));
  }
}

std::vector<std::size_t> KeyframeGrid::near(const Eigen::Vector2d& position,
                                            double radius_m) const {
  std::vector<std::size_t> found;
  if (!position.allFinite()) return found;
  // Distances that are computed in another way may differ in their last digits.
  const double reach_m = radius_m + 1e-9 * (radius_m + position.norm());
  const std::uint32_t left = along(position.x() - reach_m);
  const std::uint32_t right = along(position.x() + reach_m);
  const std::uint32_t bottom = along(position.y() - reach_m);
  const std::uint32_t top = along(position.y() + reach_m);
  const auto take = [&](const std::vector<std::uint32_t>& keyframes) {
    found.insert(found.end(), keyframes.begin(), keyframes.end());
  };
  const double cells = (1.0 + right - left) * (1.0 + top - bottom);
  if (cells > static_cast<double>(keyframes_.size())) {
    for (const auto& [cell, keyframes] : keyframes_) {
      const auto column = static_cast<std::uint32_t>(cell >> 32U);
      const auto row = static_cast<std::uint32_t>(cell);
      if (left <= column && column <= right && bottom <= row && row <= top) take(keyframes);
    }
  } else {
    for (std::uint32_t column = left; column <= right; ++column) {
      for (std::uint32_t row = bottom; row <= top; ++row) {
        const auto cell = keyframes_.find(joined(column, row));
        if (cell != keyframes_.end()) take(cell->second);
      }
    }
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace fathom

#pragma once

#include <cstddef>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include <Eigen/Core>

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

/// A spatial index of the keyframes of one trajectory that grows and moves: square cells, each with
/// the keyframes whose positions lie in it. What a search costs depends on what is near, not on the
/// length of the survey.
class KeyframeGrid {
 public:
  /// Cells of this side, > 0; best about the radius of the searches.
  explicit KeyframeGrid(double cell_m) : cell_m_(cell_m) {}

  /// Takes over what has moved or is new (TrajectoryView::moved_since); all poses are looked at
  /// where the trajectory does not know that. Another trajectory than that of the last call is
  /// taken over whole if it lies elsewhere in memory.
  void follow(const TrajectoryView& trajectory);

  /// All keyframes within `radius_m` ≥ 0 of a position, and some that are a little further;
  /// rising. Keyframes without a finite position are in no cell.
  std::vector<std::size_t> near(const Eigen::Vector2d& position, double radius_m) const;

 private:
  using Cell = std::uint64_t;

  std::uint32_t along(double coordinate_m) const;
  Cell cell_of(const Pose& pose) const;
  void place(std::size_t keyframe, const Pose& pose);

  double cell_m_;
  const TrajectoryView* trajectory_ = nullptr;
  std::uint64_t revision_ = 0;
  std::unordered_map<Cell, std::vector<std::uint32_t>> keyframes_;  ///< by cell
  std::vector<Cell> cells_;                                         ///< by keyframe
};

}  // namespace fathom

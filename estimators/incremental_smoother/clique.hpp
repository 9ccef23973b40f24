#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "estimators/incremental_smoother/motion.hpp"

namespace fathom::incremental_smoother {

/// A rigid motion that a clique and all below it have to follow, and have not yet: whoever wants to
/// know where one of their keyframes is makes up for it first (CliqueTree::settle).
struct FollowedMotion {
  std::optional<RigidMotion> motion;         ///< absent: none
  std::optional<RigidMotion> before_update;  ///< as it was before the update `set_in`
  long set_in = -1;                          ///< the last update that added to it
  long settled_in = -1;  ///< the last step since which it and those above have none
};

/// Whether a clique has its update; one that lasts is not dropped (CliqueTree::drop_updates).
enum class Kept { no, yes, lasting };

/// Variables that are eliminated together, given the separator: those of its ancestors that they
/// are linked with, directly or by what was eliminated before. Lengths count variables, three
/// numbers each. The errors of a picture are eliminated before its pose; so the pose is in every
/// separator that has them.
struct Clique {
  int parent = -1;
  int width = 0;   ///< variables eliminated here
  int height = 0;  ///< separator
  int leader = 0;  ///< of the separator, the keyframe that is eliminated first
  bool is_marked = false;
  FollowedMotion followed;
  std::vector<int> variables;  ///< first those eliminated here; the last is a pose
  std::vector<int> children;
  /// L of the columns, all rows, column-major.
  std::vector<double> panel;
  /// What the subtree says of its separator: the Schur complement, its lower blocks alone, by block
  /// columns (update_column), each column-major from its diagonal block down.
  std::vector<double> update;
  Kept kept = Kept::no;
  long used_in = -1;       ///< the update of the estimate that needed `update` last
  long queued_in = -1;     ///< what `used_in` was when it was queued
  bool is_queued = false;  ///< to be dropped
  int dropped = 0;         ///< variables to eliminate again to have it back
  /// Where the poses lay when it was factored, seen from the last of them.
  std::vector<double> layout;

  int rows() const { return width + height; }

  /// Where block column j of the update begins, j ≤ height; its columns have 3 (height − j)
  /// numbers.
  std::size_t update_column(int j) const {
    return 9 * (static_cast<std::size_t>(j) * static_cast<std::size_t>(2 * height - j + 1) / 2);
  }
};

/// Buffers of cliques that are gone, for those to come: the heap sees none of the coming and going.
class BufferPool {
 public:
  /// Of zeros.
  std::vector<double> take(std::size_t size) {
    std::vector<std::vector<double>>& free = free_[class_of(size)];
    std::vector<double> buffer;
    if (free.empty()) {
      buffer.reserve(class_size(size));
    } else {
      buffer = std::move(free.back());
      free.pop_back();
      held_ -= buffer.capacity();
    }
    buffer.assign(size, 0.0);
    return buffer;
  }

  /// Where it holds enough, the memory goes back to the heap.
  void give_back(std::vector<double> buffer) {
    if (buffer.capacity() == 0 || held_ + buffer.capacity() > kMostHeld) return;
    held_ += buffer.capacity();
    free_[class_of(buffer.capacity())].push_back(std::move(buffer));
  }

 private:
  /// Rounded up to five, six, seven or eight eighths of a power of two.
  static std::size_t class_size(std::size_t size) {
    const std::size_t step = std::bit_ceil(std::max<std::size_t>(size, 8)) / 8;
    return (size + step - 1) / step * step;
  }

  static std::size_t class_of(std::size_t size) {
    const std::size_t rounded = std::max<std::size_t>(class_size(size), 5);
    const std::size_t eighths = 8 * rounded / std::bit_ceil(std::max<std::size_t>(rounded, 8));
    return 4 * static_cast<std::size_t>(std::bit_width(rounded - 1)) + eighths - 5;
  }

  // 64 MiB.
  static constexpr std::size_t kMostHeld = std::size_t{8} << 20U;

  std::array<std::vector<std::vector<double>>, 260> free_;
  std::size_t held_ = 0;
};

}  // namespace fathom::incremental_smoother

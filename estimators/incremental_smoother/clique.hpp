#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <utility>
#include <vector>

namespace fathom::incremental_smoother {

/// Keyframes that are eliminated together, given the separator: those of its ancestors that they
/// are linked with, directly or by what was eliminated before. Lengths count keyframes, three
/// numbers each.
struct Clique {
  int parent = -1;
  int width = 0;   ///< keyframes eliminated here
  int height = 0;  ///< separator
  int leader = 0;  ///< of the separator, the keyframe that is eliminated first
  bool is_marked = false;
  std::vector<int> variables;  ///< keyframes, first those eliminated here
  std::vector<int> children;
  /// L of the columns, all rows, column-major.
  std::vector<double> panel;
  /// What the subtree says of its separator: the Schur complement, column-major, its lower blocks.
  std::vector<double> update;
  /// Where the variables lay when it was factored, seen from the last of them.
  std::vector<double> layout;

  int rows() const { return width + height; }
};

/// Buffers of cliques that are gone, for those to come: the heap sees none of the coming and going.
class BufferPool {
 public:
  /// Of zeros.
  std::vector<double> take(std::size_t size) {
    std::vector<std::vector<double>>& free = free_[class_of(size)];
    std::vector<double> buffer;
    if (free.empty()) {
      buffer.reserve(std::size_t{1} << class_of(size));
    } else {
      buffer = std::move(free.back());
      free.pop_back();
    }
    buffer.assign(size, 0.0);
    return buffer;
  }

  void give_back(std::vector<double>&& buffer) {
    if (buffer.capacity() == 0) return;
    // Rounded down: a buffer of a class holds all that is asked of the class.
    free_[std::bit_width(buffer.capacity()) - 1].push_back(std::move(buffer));
  }

 private:
  static std::size_t class_of(std::size_t size) {
    return static_cast<std::size_t>(std::bit_width(size > 0 ? size - 1 : 0));
  }

  std::array<std::vector<std::vector<double>>, 64> free_;
};

}  // namespace fathom::incremental_smoother

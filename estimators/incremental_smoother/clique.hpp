#pragma once

#include <vector>

namespace fathom::incremental_smoother {

/// Keyframes that are eliminated together, given the separator: those of its ancestors that they are
/// linked with, directly or by what was eliminated before.
struct Clique {
  int parent = -1;
  int width = 0;   ///< keyframes eliminated here
  int height = 0;  ///< separator
  int leader = 0;  ///< the separator that is eliminated first
  bool is_marked = false;
  std::vector<int> variables;  ///< keyframes, first those eliminated here
  std::vector<int> children;
  /// L of the columns, 3 (width + height) rows, column-major.
  std::vector<double> panel;
  /// What the subtree says of its separator: the Schur complement, both triangles, column-major.
  std::vector<double> update;
  /// Headings of the variables when it was factored.
  std::vector<double> headings_rad;

  int rows() const { return width + height; }
};

}  // namespace fathom::incremental_smoother

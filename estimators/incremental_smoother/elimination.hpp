#pragma once

#include <cstddef>
#include <vector>

#include "estimators/incremental_smoother/minimum_degree.hpp"

namespace fathom::incremental_smoother {

/// Columns that are eliminated together: positions [first, first + width), and the rows below them.
struct Front {
  int first = 0;
  int width = 0;
  std::size_t rows = 0;  ///< begin in Elimination::rows
  int height = 0;
};

/// The pattern of the factor of a QuotientGraph in a given order, in fronts, children before
/// parents. The last node is fixed: it is a row of others, and has no front. Where fronts of one
/// branch have nearly the same rows they are one.
class Elimination {
 public:
  void analyse(const QuotientGraph& graph, const std::vector<int>& order);

  const std::vector<Front>& fronts() const { return fronts_; }
  int node_at(int position) const { return node_[at(position)]; }
  /// Positions.
  int row(std::size_t i) const { return rows_[i]; }

 private:
  void collect_neighbours(const QuotientGraph& graph, const std::vector<int>& order);
  void find_columns(const QuotientGraph& graph);
  void sort_by_branches(const std::vector<int>& order);
  void merge_fronts();

  std::vector<int> position_;
  std::vector<int> link_start_;  ///< by position in the order given
  std::vector<int> link_rows_;
  std::vector<int> first_element_;  ///< that a column is the first of
  std::vector<int> next_element_;
  std::vector<std::size_t> start_;  ///< of the columns, in the order given
  std::vector<int> columns_;
  std::vector<int> parent_;
  std::vector<int> first_child_;
  std::vector<int> sibling_;
  std::vector<int> seen_by_;

  std::vector<int> old_position_;  ///< by the positions that fronts have
  std::vector<int> new_position_;
  std::vector<int> node_;
  std::vector<Front> fronts_;
  std::vector<std::size_t> filled_;  ///< blocks of a front that are not explicit zeros
  std::vector<int> rows_;
};

}  // namespace fathom::incremental_smoother

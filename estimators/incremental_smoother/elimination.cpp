#include "estimators/incremental_smoother/elimination.hpp"

#include <algorithm>
#include <numeric>

#include "estimators/support/sparse/elimination_tree.hpp"

namespace fathom::incremental_smoother {
using sparse::blocks_of;
using sparse::is_worth_merging;

void Elimination::analyse(const QuotientGraph& graph, const std::vector<int>& order) {
  collect_neighbours(graph, order);
  find_columns(graph);
  sort_by_branches(order);
  merge_fronts();
}

void Elimination::collect_neighbours(const QuotientGraph& graph, const std::vector<int>& order) {
  const int n = graph.size;
  position_.resize(at(n));
  for (int p = 0; p < n; ++p) position_[at(order[at(p)])] = p;
  link_start_.assign(at(n) + 1, 0);
  for (const auto& link : graph.links) {
    ++link_start_[at(std::min(position_[at(link.a)], position_[at(link.b)])) + 1];
  }
  std::partial_sum(link_start_.begin(), link_start_.end(), link_start_.begin());
  link_rows_.resize(graph.links.size());
  for (const auto& link : graph.links) {
    const auto [first, second] = std::minmax(position_[at(link.a)], position_[at(link.b)]);
    link_rows_[at(--link_start_[at(first) + 1])] = second;
  }
  // Filled from behind: entry p + 1 now holds the begin of p.
  link_start_.erase(link_start_.begin());
  link_start_.push_back(static_cast<int>(graph.links.size()));
  first_element_.assign(at(n), -1);
  next_element_.resize(at(graph.elements()));
  for (int g = 0; g < graph.elements(); ++g) {
    int first = n;
    for (int p = graph.element_start[at(g)]; p < graph.element_start[at(g) + 1]; ++p) {
      first = std::min(first, position_[at(graph.element_nodes[at(p)])]);
    }
    if (first == n) continue;
    next_element_[at(g)] = first_element_[at(first)];
    first_element_[at(first)] = g;
  }
}

void Elimination::find_columns(const QuotientGraph& graph) {
  const int n = graph.size;
  start_.assign(1, 0);
  columns_.clear();
  parent_.assign(at(n), -1);
  first_child_.assign(at(n), -1);
  sibling_.assign(at(n), -1);
  seen_by_.assign(at(n), -1);
  for (int j = 0; j < n; ++j) {
    int least = n;
    const auto add = [&](int i) {
      if (i <= j || seen_by_[at(i)] == j) return;
      seen_by_[at(i)] = j;
      columns_.push_back(i);
      least = std::min(least, i);
    };
    for (int p = link_start_[at(j)]; p < link_start_[at(j) + 1]; ++p) add(link_rows_[at(p)]);
    for (int g = first_element_[at(j)]; g >= 0; g = next_element_[at(g)]) {
      for (int p = graph.element_start[at(g)]; p < graph.element_start[at(g) + 1]; ++p) {
        add(position_[at(graph.element_nodes[at(p)])]);
      }
    }
    for (int child = first_child_[at(j)]; child >= 0; child = sibling_[at(child)]) {
      for (std::size_t p = start_[at(child)]; p < start_[at(child) + 1]; ++p) add(columns_[p]);
    }
    start_.push_back(columns_.size());
    if (least == n) continue;
    parent_[at(j)] = least;
    sibling_[at(j)] = first_child_[at(least)];
    first_child_[at(least)] = j;
  }
}

void Elimination::sort_by_branches(const std::vector<int>& order) {
  old_position_ = sparse::postorder(parent_);
  new_position_.resize(old_position_.size());
  node_.resize(old_position_.size());
  for (std::size_t p = 0; p < old_position_.size(); ++p) {
    new_position_[at(old_position_[p])] = static_cast<int>(p);
    node_[p] = order[at(old_position_[p])];
  }
}

void Elimination::merge_fronts() {
  fronts_.clear();
  filled_.clear();
  rows_.clear();
  for (int j = 0; j + 1 < static_cast<int>(node_.size()); ++j) {
    const int old = old_position_[at(j)];
    const auto height = static_cast<int>(start_[at(old) + 1] - start_[at(old)]);
    Front next{j, 1, 0, height};
    std::size_t filled = 1 + at(height);
    while (!fronts_.empty()) {
      const Front& child = fronts_.back();
      const int last = old_position_[at(child.first + child.width - 1)];
      if (parent_[at(last)] < 0 || new_position_[at(parent_[at(last)])] != next.first) break;
      const int width = child.width + next.width;
      const std::size_t blocks = blocks_of(width, height);
      const std::size_t both = filled_.back() + filled;
      if (both != blocks && !is_worth_merging(width, blocks - both, blocks)) break;
      next.first = child.first;
      next.width = width;
      filled = both;
      fronts_.pop_back();
      filled_.pop_back();
    }
    fronts_.push_back(next);
    filled_.push_back(filled);
  }
  for (Front& front : fronts_) {
    const int last = old_position_[at(front.first + front.width - 1)];
    front.rows = rows_.size();
    for (std::size_t p = start_[at(last)]; p < start_[at(last) + 1]; ++p) {
      rows_.push_back(new_position_[at(columns_[p])]);
    }
    std::sort(rows_.begin() + static_cast<std::ptrdiff_t>(front.rows), rows_.end());
  }
}

}  // namespace fathom::incremental_smoother

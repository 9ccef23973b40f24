#include "estimators/incremental_smoother/clique_tree.hpp"

#include <algorithm>
#include <limits>

namespace fathom::incremental_smoother {

void CliqueTree::clear() {
  settle();
  followers_.clear();
  unmark();
  free_.clear();
  for (int i = static_cast<int>(cliques_.size()) - 1; i >= 0; --i) {
    release_update(cliques_[at(i)]);
    cliques_[at(i)].is_queued = false;
    free_.push_back(i);
  }
  queue_.clear();
  has_dropped_ = false;
  std::fill(clique_of_.begin(), clique_of_.end(), -1);
  root_ = -1;
}

void CliqueTree::grow() {
  const auto n = at(problem_.size());
  clique_of_.resize(n, -1);
  // Keyframe 0 is never eliminated.
  order_.resize(n, std::numeric_limits<long>::max());
  index_of_.resize(n, -1);
  row_of_.resize(n, 0);
  x_.resize(3 * n);
  before_.resize(n);
}

void CliqueTree::mark_up(int keyframe) {
  for (int i = clique_of_[at(keyframe)]; i >= 0 && !cliques_[at(i)].is_marked;
       i = cliques_[at(i)].parent) {
    cliques_[at(i)].is_marked = true;
    marked_.push_back(i);
  }
}

void CliqueTree::mark_all() {
  if (root_ < 0) return;
  marked_.push_back(root_);
  for (std::size_t next = 0; next < marked_.size(); ++next) {
    Clique& c = cliques_[at(marked_[next])];
    c.is_marked = true;
    marked_.insert(marked_.end(), c.children.begin(), c.children.end());
  }
  std::reverse(marked_.begin(), marked_.end());
}

// Children before parents.
void CliqueTree::sort_marked() {
  std::sort(marked_.begin(), marked_.end(), [&](int a, int b) {
    return order_[at(cliques_[at(a)].variables[0])] < order_[at(cliques_[at(b)].variables[0])];
  });
}

void CliqueTree::unmark() {
  for (const int i : marked_) cliques_[at(i)].is_marked = false;
  marked_.clear();
}

void CliqueTree::find_affected(std::span<const int> keyframes) {
  unmark();
  affected_.clear();
  for (const int v : keyframes) {
    if (clique_of_[at(v)] >= 0) {
      mark_up(v);
    } else if (index_of_[at(v)] < 0) {
      index_of_[at(v)] = 0;
      affected_.push_back(v);
    }
  }
  for (const int i : marked_) {
    settle_path(i);
    const Clique& c = cliques_[at(i)];
    affected_.insert(affected_.end(), c.variables.begin(), c.variables.begin() + c.width);
  }
  std::sort(affected_.begin(), affected_.end());
  affected_.push_back(0);
  for (std::size_t i = 0; i < affected_.size(); ++i) {
    index_of_[at(affected_[i])] = static_cast<int>(i);
  }
}

void CliqueTree::form_quotient_graph() {
  quotient_.clear();
  quotient_.size = static_cast<int>(affected_.size());
  for (const int v : affected_) {
    problem_.for_each_edge(v, [&](int, int other) {
      if (other < v && index_of_[at(other)] >= 0) {
        quotient_.links.push_back({index_of_[at(v)], index_of_[at(other)]});
      }
    });
  }
  orphans_.clear();
  for (const int i : marked_) {
    for (const int child : cliques_[at(i)].children) {
      const Clique& c = cliques_[at(child)];
      if (c.is_marked) continue;
      orphans_.push_back(child);
      for (int j = c.width; j < c.rows(); ++j) {
        quotient_.element_nodes.push_back(index_of_[at(c.variables[at(j)])]);
      }
      quotient_.element_start.push_back(static_cast<int>(quotient_.element_nodes.size()));
    }
  }
}

void CliqueTree::release_marked() {
  for (const int i : marked_) release_update(cliques_[at(i)]);
  free_.insert(free_.end(), marked_.begin(), marked_.end());
  unmark();
}

int CliqueTree::new_clique() {
  if (free_.empty()) {
    cliques_.emplace_back();
    return static_cast<int>(cliques_.size()) - 1;
  }
  const int i = free_.back();
  free_.pop_back();
  return i;
}

// How many of the affected keyframes are older than this one; none where there are few.
int CliqueTree::older_than(int keyframe) const {
  constexpr int kFew = 50;
  const auto end = affected_.end() - 1;  // keyframe 0
  const auto older = static_cast<int>(std::ranges::lower_bound(affected_.begin(), end, keyframe) -
                                      affected_.begin());
  return older < kFew ? 0 : older;
}

void CliqueTree::build(int first, int newest) {
  elimination_.analyse(quotient_, minimum_degree_.order(quotient_, first, index_of_[at(newest)],
                                                        quotient_.size - 1));
  built_.clear();
  for (const Front& front : elimination_.fronts()) {
    const int i = new_clique();
    Clique& c = cliques_[at(i)];
    c.width = front.width;
    c.height = front.height;
    c.children.clear();
    c.variables.clear();
    c.followed = {};
    c.followed.settled_in = step_;
    for (int j = 0; j < front.width; ++j) {
      const int v = affected_[at(elimination_.node_at(front.first + j))];
      c.variables.push_back(v);
      clique_of_[at(v)] = i;
      order_[at(v)] = next_order_++;
    }
    for (int j = 0; j < front.height; ++j) {
      const int position = elimination_.row(front.rows + at(j));
      c.variables.push_back(affected_[at(elimination_.node_at(position))]);
    }
    built_.push_back(i);
  }
  for (const int i : built_) attach(i);
  for (const int i : orphans_) attach(i);
}

// To the clique of the separator that is eliminated first.
void CliqueTree::attach(int clique) {
  Clique& c = cliques_[at(clique)];
  c.leader = c.variables[at(c.width)];
  for (int j = c.width + 1; j < c.rows(); ++j) {
    const int v = c.variables[at(j)];
    if (order_[at(v)] < order_[at(c.leader)]) c.leader = v;
  }
  c.parent = clique_of_[at(c.leader)];
  if (c.parent < 0) {
    root_ = clique;
  } else {
    cliques_[at(c.parent)].children.push_back(clique);
  }
}

bool CliqueTree::refactor(std::span<const int> keyframes, int newest) {
  grow();
  find_affected(keyframes);
  form_quotient_graph();
  release_marked();
  build(older_than(*std::ranges::min_element(keyframes)), newest);
  for (const int v : affected_) index_of_[at(v)] = -1;
  if (factor(built_)) return true;
  clear();
  return false;
}

bool CliqueTree::relinearise(std::span<const int> keyframes) {
  unmark();
  for (const int v : keyframes) mark_up(v);
  sort_marked();
  for (const int i : marked_) settle_path(i);
  const bool done = factor(marked_);
  unmark();
  if (!done) clear();
  return done;
}

}  // namespace fathom::incremental_smoother

#include "estimators/incremental_smoother/clique_tree.hpp"

#include <algorithm>
#include <limits>

namespace fathom::incremental_smoother {

void CliqueTree::clear() {
  settle();
  following_.told.clear();
  unmark();
  free_.clear();
  for (int i = static_cast<int>(cliques_.size()) - 1; i >= 0; --i) {
    release_update(cliques_[at(i)]);
    cliques_[at(i)].is_queued = false;
    free_.push_back(i);
  }
  updates_.queue.clear();
  updates_.has_dropped = false;
  std::fill(order_.clique_of.begin(), order_.clique_of.end(), -1);
  order_.root = -1;
}

void CliqueTree::grow() {
  const auto n = at(problem_.size());
  order_.clique_of.resize(n, -1);
  // Keyframe 0 is never eliminated.
  order_.when.resize(n, std::numeric_limits<long>::max());
  again_.index_of.resize(n, -1);
  work_.row_of.resize(n, 0);
  x_.resize(3 * n);
  last_.before.resize(n);
}

void CliqueTree::mark_up(int keyframe) {
  for (int i = order_.clique_of[at(keyframe)]; i >= 0 && !cliques_[at(i)].is_marked;
       i = cliques_[at(i)].parent) {
    cliques_[at(i)].is_marked = true;
    marked_.push_back(i);
  }
}

void CliqueTree::mark_all() {
  if (order_.root < 0) return;
  marked_.push_back(order_.root);
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
    return order_.when[at(cliques_[at(a)].variables[0])] <
           order_.when[at(cliques_[at(b)].variables[0])];
  });
}

void CliqueTree::unmark() {
  for (const int i : marked_) cliques_[at(i)].is_marked = false;
  marked_.clear();
  is_solved_ = false;
}

void CliqueTree::find_affected(std::span<const int> keyframes) {
  unmark();
  again_.affected.clear();
  for (const int v : keyframes) {
    if (order_.clique_of[at(v)] >= 0) {
      mark_up(v);
    } else if (again_.index_of[at(v)] < 0) {
      again_.index_of[at(v)] = 0;
      again_.affected.push_back(v);
    }
  }
  for (const int i : marked_) {
    settle_path(i);
    const Clique& c = cliques_[at(i)];
    again_.affected.insert(again_.affected.end(), c.variables.begin(),
                           c.variables.begin() + c.width);
  }
  std::sort(again_.affected.begin(), again_.affected.end());
  again_.affected.push_back(0);
  for (std::size_t i = 0; i < again_.affected.size(); ++i) {
    again_.index_of[at(again_.affected[i])] = static_cast<int>(i);
  }
}

void CliqueTree::form_quotient_graph() {
  again_.quotient.clear();
  again_.quotient.size = static_cast<int>(again_.affected.size());
  for (const int v : again_.affected) {
    problem_.for_each_edge(v, [&](int, int other) {
      if (other < v && again_.index_of[at(other)] >= 0) {
        again_.quotient.links.push_back({again_.index_of[at(v)], again_.index_of[at(other)]});
      }
    });
  }
  again_.orphans.clear();
  for (const int i : marked_) {
    for (const int child : cliques_[at(i)].children) {
      const Clique& c = cliques_[at(child)];
      if (c.is_marked) continue;
      again_.orphans.push_back(child);
      for (int j = c.width; j < c.rows(); ++j) {
        again_.quotient.element_nodes.push_back(again_.index_of[at(c.variables[at(j)])]);
      }
      again_.quotient.element_start.push_back(
          static_cast<int>(again_.quotient.element_nodes.size()));
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
  const auto end = again_.affected.end() - 1;  // keyframe 0
  const auto older = static_cast<int>(
      std::ranges::lower_bound(again_.affected.begin(), end, keyframe) - again_.affected.begin());
  return older < kFew ? 0 : older;
}

void CliqueTree::build(int first, int newest) {
  again_.elimination.analyse(
      again_.quotient,
      again_.minimum_degree.order(again_.quotient, first, again_.index_of[at(newest)],
                                  again_.quotient.size - 1));
  again_.built.clear();
  for (const Front& front : again_.elimination.fronts()) {
    const int i = new_clique();
    Clique& c = cliques_[at(i)];
    c.width = front.width;
    c.height = front.height;
    c.children.clear();
    c.variables.clear();
    c.followed = {};
    c.followed.settled_in = last_.number;
    for (int j = 0; j < front.width; ++j) {
      const int v = again_.affected[at(again_.elimination.node_at(front.first + j))];
      c.variables.push_back(v);
      order_.clique_of[at(v)] = i;
      order_.when[at(v)] = order_.next++;
    }
    for (int j = 0; j < front.height; ++j) {
      const int position = again_.elimination.row(front.rows + at(j));
      c.variables.push_back(again_.affected[at(again_.elimination.node_at(position))]);
    }
    again_.built.push_back(i);
  }
  for (const int i : again_.built) attach(i);
  for (const int i : again_.orphans) attach(i);
}

// To the clique of the separator that is eliminated first.
void CliqueTree::attach(int clique) {
  Clique& c = cliques_[at(clique)];
  c.leader = c.variables[at(c.width)];
  for (int j = c.width + 1; j < c.rows(); ++j) {
    const int v = c.variables[at(j)];
    if (order_.when[at(v)] < order_.when[at(c.leader)]) c.leader = v;
  }
  c.parent = order_.clique_of[at(c.leader)];
  if (c.parent < 0) {
    order_.root = clique;
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
  for (const int v : again_.affected) again_.index_of[at(v)] = -1;
  if (factor(again_.built)) return true;
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

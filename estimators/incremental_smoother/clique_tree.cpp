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
  order_.clique_of.fill(-1);
  order_.root = -1;
}

void CliqueTree::grow() {
  const auto n = at(problem_.size());
  const std::size_t errors = problem_.error_count();
  order_.clique_of.resize(n, errors, -1);
  // Keyframe 0 is never eliminated.
  order_.when.resize(n, errors, std::numeric_limits<long>::max());
  again_.index_of.resize(n, errors, -1);
  work_.row_of.resize(n, errors);
  x_.resize(n, errors);
  last_.before.resize(n, errors);
}

void CliqueTree::mark_up(int variable) {
  for (int i = order_.clique_of[variable]; i >= 0 && !cliques_[at(i)].is_marked;
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
    return order_.when[cliques_[at(a)].variables[0]] < order_.when[cliques_[at(b)].variables[0]];
  });
}

void CliqueTree::unmark() {
  for (const int i : marked_) cliques_[at(i)].is_marked = false;
  marked_.clear();
  is_solved_ = false;
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

void CliqueTree::build(int first, int newest) {
  again_.elimination.analyse(again_.quotient, ordered(first, newest));
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
      order_.clique_of[v] = i;
      order_.when[v] = order_.next++;
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

// To the clique of the separator's variable that is eliminated first.
void CliqueTree::attach(int clique) {
  Clique& c = cliques_[at(clique)];
  int first = c.variables[at(c.width)];
  c.leader = c.variables.back();
  for (int j = c.width; j < c.rows(); ++j) {
    const int v = c.variables[at(j)];
    if (order_.when[v] < order_.when[first]) first = v;
    if (!is_errors(v) && order_.when[v] < order_.when[c.leader]) c.leader = v;
  }
  c.parent = order_.clique_of[first];
  if (c.parent < 0) {
    order_.root = clique;
  } else {
    cliques_[at(c.parent)].children.push_back(clique);
  }
}

bool CliqueTree::refactor(std::span<const int> variables, int newest) {
  grow();
  find_affected(variables);
  form_quotient_graph();
  release_marked();
  build(older_than(keyframe_of(*std::ranges::min_element(variables, {}, keyframe_of))), newest);
  for (const int v : again_.affected) again_.index_of[v] = -1;
  if (factor(again_.built)) return true;
  clear();
  return false;
}

bool CliqueTree::relinearise(std::span<const int> variables) {
  unmark();
  for (const int v : variables) mark_up(v);
  sort_marked();
  for (const int i : marked_) settle_path(i);
  const bool done = factor(marked_);
  unmark();
  if (!done) clear();
  return done;
}

}  // namespace fathom::incremental_smoother

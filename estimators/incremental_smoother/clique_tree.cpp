#include "estimators/incremental_smoother/clique_tree.hpp"

#include <algorithm>

#include "estimators/incremental_smoother/fronts.hpp"

namespace fathom::incremental_smoother {
namespace {

struct Forward {
  const std::vector<Clique>& cliques;
  std::span<const int> which;
  double* x;
  double* gathered;

  FATHOM_INLINE bool run() const {
    for (const int i : which) FrontSubstitution{cliques[at(i)], x, gathered}.forward();
    return true;
  }
};

struct Backward {
  const Clique& clique;
  double* x;
  double* gathered;

  FATHOM_INLINE bool run() const {
    FrontSubstitution{clique, x, gathered}.backward();
    return true;
  }
};

}  // namespace

void CliqueTree::clear() {
  for (const int i : marked_) cliques_[at(i)].is_marked = false;
  marked_.clear();
  free_.clear();
  for (int i = static_cast<int>(cliques_.size()) - 1; i >= 0; --i) free_.push_back(i);
  std::fill(clique_of_.begin(), clique_of_.end(), -1);
  roots_.clear();
}

void CliqueTree::mark_up(int clique) {
  for (int i = clique; i >= 0 && !cliques_[at(i)].is_marked; i = cliques_[at(i)].parent) {
    cliques_[at(i)].is_marked = true;
    marked_.push_back(i);
  }
}

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
  const auto n = at(problem_.size());
  clique_of_.resize(n, -1);
  order_.resize(n, 0);
  index_of_.resize(n, -1);
  row_of_.resize(n, 0);
  x_.resize(3 * n);
  is_moved_.resize(n);
  affected_.clear();
  for (const int v : keyframes) {
    if (clique_of_[at(v)] >= 0) {
      mark_up(clique_of_[at(v)]);
    } else if (index_of_[at(v)] < 0) {
      index_of_[at(v)] = 0;
      affected_.push_back(v);
    }
  }
  for (const int i : marked_) {
    const Clique& c = cliques_[at(i)];
    affected_.insert(affected_.end(), c.variables.begin(), c.variables.begin() + c.width);
  }
  std::sort(affected_.begin(), affected_.end());
  for (std::size_t i = 0; i < affected_.size(); ++i) index_of_[at(affected_[i])] = int(i);
}

void CliqueTree::describe_rest() {
  rest_.clear();
  rest_.size = static_cast<int>(affected_.size());
  for (const int v : affected_) {
    problem_.for_each_edge(v, [&](int, int other) {
      if (other < v && index_of_[at(other)] >= 0) {
        rest_.links.push_back({index_of_[at(v)], index_of_[at(other)]});
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
        rest_.group_nodes.push_back(index_of_[at(c.variables[at(j)])]);
      }
      rest_.group_start.push_back(static_cast<int>(rest_.group_nodes.size()));
    }
  }
}

void CliqueTree::release_marked() {
  for (const int i : marked_) {
    cliques_[at(i)].is_marked = false;
    free_.push_back(i);
  }
  marked_.clear();
  std::erase_if(roots_, [&](int root) {
    return index_of_[at(cliques_[at(root)].variables[0])] >= 0;
  });
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

void CliqueTree::build(int newest) {
  elimination_.analyse(rest_, minimum_degree_.order(rest_, index_of_[at(newest)]));
  built_.clear();
  for (const Front& front : elimination_.fronts()) {
    const int i = new_clique();
    Clique& c = cliques_[at(i)];
    c.parent = -1;
    c.width = front.width;
    c.height = front.height;
    c.children.clear();
    c.variables.clear();
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
    c.headings_rad.resize(at(c.rows()));
    built_.push_back(i);
  }
  for (const int i : built_) {
    Clique& c = cliques_[at(i)];
    if (c.height == 0) {
      roots_.push_back(i);
      continue;
    }
    c.parent = clique_of_[at(c.variables[at(c.width)])];
    cliques_[at(c.parent)].children.push_back(i);
  }
  for (const int i : orphans_) {
    Clique& c = cliques_[at(i)];
    int first = c.variables[at(c.width)];
    for (int j = c.width + 1; j < c.rows(); ++j) {
      const int v = c.variables[at(j)];
      if (order_[at(v)] < order_[at(first)]) first = v;
    }
    c.parent = clique_of_[at(first)];
    cliques_[at(c.parent)].children.push_back(i);
  }
}

bool CliqueTree::refactor(std::span<const int> keyframes, int newest) {
  find_affected(keyframes);
  describe_rest();
  release_marked();
  build(newest);
  for (const int v : affected_) index_of_[at(v)] = -1;
  if (factor(built_)) return true;
  clear();
  return false;
}

bool CliqueTree::refresh(std::span<const int> cliques) {
  for (const int i : cliques) mark_up(i);
  sort_marked();
  const bool done = factor(marked_);
  unmark();
  if (!done) clear();
  return done;
}

bool CliqueTree::factor(std::span<const int> which) {
  refactored_ = 0;
  for (const int i : which) {
    const Clique& c = cliques_[at(i)];
    refactored_ += c.width;
    packed_.resize(std::max(packed_.size(), at(c.width) * 9));
    signs_.resize(std::max(signs_.size(), at(c.width) * 3));
    gathered_.resize(std::max(gathered_.size(), at(c.rows()) * 3));
  }
  FrontFactorisation run{problem_,       cliques_,       which,         order_.data(),
                         row_of_.data(), packed_.data(), signs_.data()};
  return sparse_gauss_newton::run_for_processor(run);
}

bool CliqueTree::goes_down(const Clique& c) const {
  if (c.is_marked) return true;
  for (int j = c.width; j < c.rows(); ++j) {
    if (is_moved_[at(c.variables[at(j)])] != 0) return true;
  }
  return false;
}

void CliqueTree::solve(std::span<const int> sources, const std::vector<Vec3>& gradient,
                       const std::vector<Weight>& weights, double negligible) {
  for (const int v : sources) mark_up(clique_of_[at(v)]);
  sort_marked();
  for (const int i : marked_) {
    const Clique& c = cliques_[at(i)];
    for (int j = 0; j < c.width; ++j) {
      const int v = c.variables[at(j)];
      for (int a = 0; a < 3; ++a) x_[at(3 * v + a)] = -gradient[at(v)][at(a)];
    }
  }
  Forward forward{cliques_, marked_, x_.data(), gathered_.data()};
  sparse_gauss_newton::run_for_processor(forward);
  visited_.clear();
  promised_ = 0.0;
  stack_.assign(roots_.begin(), roots_.end());
  while (!stack_.empty()) {
    const int i = stack_.back();
    stack_.pop_back();
    const Clique& c = cliques_[at(i)];
    if (!goes_down(c)) continue;
    visited_.push_back(i);
    if (!c.is_marked) {
      for (int j = 0; j < c.width; ++j) {
        for (int a = 0; a < 3; ++a) x_[at(3 * c.variables[at(j)] + a)] = 0.0;
      }
    }
    Backward backward{c, x_.data(), gathered_.data()};
    sparse_gauss_newton::run_for_processor(backward);
    for (int j = 0; j < c.width; ++j) {
      const int v = c.variables[at(j)];
      const double* d = x_.data() + 3 * v;
      const Weight& w = weights[at(v)];
      const double moved = w.position * (d[0] * d[0] + d[1] * d[1]) + w.heading * d[2] * d[2];
      is_moved_[at(v)] = moved > negligible ? 1 : 0;
      if (!c.is_marked) continue;
      for (int a = 0; a < 3; ++a) promised_ -= gradient[at(v)][at(a)] * d[a];
    }
    stack_.insert(stack_.end(), c.children.begin(), c.children.end());
  }
  unmark();
}

}  // namespace fathom::incremental_smoother

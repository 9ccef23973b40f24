#include "estimators/incremental_smoother/clique_tree.hpp"

#include <algorithm>
#include <limits>

#include "estimators/incremental_smoother/fronts.hpp"
#include "estimators/incremental_smoother/motion.hpp"

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
  double* gathered;

  FATHOM_INLINE bool run() const {
    FrontSubstitution{clique, nullptr, gathered}.backward();
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
  root_ = -1;
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

void CliqueTree::grow() {
  const auto n = at(problem_.size());
  clique_of_.resize(n, -1);
  order_.resize(n, std::numeric_limits<long>::max());
  index_of_.resize(n, -1);
  row_of_.resize(n, 0);
  x_.resize(3 * n);
  before_.resize(n);
}

void CliqueTree::find_affected(std::span<const int> keyframes) {
  affected_.clear();
  unmark();
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
  affected_.push_back(0);
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
  elimination_.analyse(rest_, minimum_degree_.order(rest_, index_of_[at(newest)], rest_.size - 1));
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
    c.headings_rad.resize(at(3 * c.rows()));
    built_.push_back(i);
  }
  for (const int i : built_) attach(i);
  for (const int i : orphans_) attach(i);
}

// To the clique of the separator that is eliminated first.
void CliqueTree::attach(int clique) {
  Clique& c = cliques_[at(clique)];
  int first = c.variables[at(c.width)];
  for (int j = c.width + 1; j < c.rows(); ++j) {
    const int v = c.variables[at(j)];
    if (order_[at(v)] < order_[at(first)]) first = v;
  }
  c.leader = first;
  c.parent = clique_of_[at(first)];
  if (c.parent < 0) {
    root_ = clique;
  } else {
    cliques_[at(c.parent)].children.push_back(clique);
  }
}

bool CliqueTree::refactor(std::span<const int> keyframes, int newest) {
  grow();
  find_affected(keyframes);
  describe_rest();
  release_marked();
  build(newest);
  for (const int v : affected_) index_of_[at(v)] = -1;
  static int calls=0; if (getenv("DBG2") && ++calls==atoi(getenv("DBG2"))) { fprintf(stderr,"touched:"); for (int v:keyframes) fprintf(stderr," %d",v); fprintf(stderr,"\naffected %zu orphans %zu built %zu\n",affected_.size(),orphans_.size(),built_.size()); for (int i: built_) { auto&c=cliques_[i]; fprintf(stderr,"%d->%d w%d h%d:",i,c.parent,c.width,c.height); for(int v:c.variables) fprintf(stderr," %d",v); fprintf(stderr,"\n"); } exit(0);}
  if (factor(built_)) return true;
  clear();
  return false;
}

bool CliqueTree::refresh(std::span<const int> cliques) {
  unmark();
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

double CliqueTree::forward(std::span<const int> sources, const std::vector<Vec3>& gradient,
                           const std::vector<Vec3>& ignored) {
  unmark();
  for (const int v : sources) mark_up(clique_of_[at(v)]);
  sort_marked();
  for (const int i : marked_) {
    const Clique& c = cliques_[at(i)];
    for (int j = 0; j < c.width; ++j) {
      const auto v = at(c.variables[at(j)]);
      for (std::size_t a = 0; a < 3; ++a) x_[3 * v + a] = ignored[v][a] - gradient[v][a];
    }
  }
  Forward run{cliques_, marked_, x_.data(), gathered_.data()};
  sparse_gauss_newton::run_for_processor(run);
  double sum = 0.0;
  for (const int i : marked_) {
    const Clique& c = cliques_[at(i)];
    for (int j = 0; j < c.width; ++j) {
      const double* y = x_.data() + 3 * c.variables[at(j)];
      sum += y[0] * y[0] + y[1] * y[1] + y[2] * y[2];
    }
  }
  return sum;
}

void CliqueTree::descend(const std::vector<Weight>& weights, double negligible) {
  moved_.clear();
  bent_.clear();
  bent_cliques_.clear();
  before_[0] = problem_.nodes[0];
  if (root_ >= 0) stack_.assign(1, root_);
  while (!stack_.empty()) {
    const int i = stack_.back();
    stack_.pop_back();
    bend(i, weights, negligible);
  }
  unmark();
}

void CliqueTree::bend(int clique, const std::vector<Weight>& weights, double negligible) {
  const Clique& c = cliques_[at(clique)];
  const RigidMotion rigid(before_[at(c.leader)], problem_.nodes[at(c.leader)]);
  double bent = 0.0;
  double moved = 0.0;
  for (int j = c.width; j < c.rows(); ++j) {
    const auto s = at(c.variables[at(j)]);
    const Node& now = problem_.nodes[s];
    const Weight& w = weights[s];
    double* d = gathered_.data() + 3 * j;
    offset_of(rigid(before_[s]), now, d);
    bent = std::max(bent, w.position * (d[0] * d[0] + d[1] * d[1]) + w.heading * d[2] * d[2]);
    double all[3];
    offset_of(before_[s], now, all);
    moved = std::max(moved,
                     w.position * (all[0] * all[0] + all[1] * all[1]) + w.heading * all[2] * all[2]);
  }
  if (!c.is_marked && bent <= negligible) {
    if (moved > negligible) follow(clique, rigid);
    return;
  }
  for (int j = 0; j < c.width; ++j) {
    for (int a = 0; a < 3; ++a) {
      gathered_[at(3 * j + a)] = c.is_marked ? x_[at(3 * c.variables[at(j)] + a)] : 0.0;
    }
  }
  Backward backward{c, gathered_.data()};
  sparse_gauss_newton::run_for_processor(backward);
  for (int j = 0; j < c.width; ++j) {
    const int v = c.variables[at(j)];
    Node& node = problem_.nodes[at(v)];
    before_[at(v)] = node;
    node = corrected(rigid(node), gathered_.data() + 3 * j);
    moved_.push_back(v);
    bent_.push_back(v);
  }
  bent_cliques_.push_back(clique);
  stack_.insert(stack_.end(), c.children.begin(), c.children.end());
}

void CliqueTree::follow(int clique, const RigidMotion& rigid) {
  const std::size_t bottom = stack_.size();
  stack_.push_back(clique);
  while (stack_.size() > bottom) {
    const Clique& c = cliques_[at(stack_.back())];
    stack_.pop_back();
    for (int j = 0; j < c.width; ++j) {
      const int v = c.variables[at(j)];
      Node& node = problem_.nodes[at(v)];
      before_[at(v)] = node;
      node = rigid(node);
      moved_.push_back(v);
    }
    stack_.insert(stack_.end(), c.children.begin(), c.children.end());
  }
}

}  // namespace fathom::incremental_smoother

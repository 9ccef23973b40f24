// The solves of CliqueTree.

#include <algorithm>
#include <cassert>
#include <cmath>

#include "estimators/incremental_smoother/clique_tree.hpp"
#include "estimators/incremental_smoother/fronts.hpp"

namespace fathom::incremental_smoother {
namespace {

// A correction of a variable in squared sigmas, as far as its own measurements tell.
double size_of(const double* d, const Weight& w) {
  return w.position * (d[0] * d[0] + d[1] * d[1]) + w.heading * d[2] * d[2];
}

// Whether a keyframe is seen in another place or direction than it was; far away it may move more.
bool has_left(const double* was, const double* now, double limit_m, double limit_rad) {
  if (std::abs(now[2] - was[2]) > limit_rad) return true;
  const double dx = now[0] - was[0];
  const double dy = now[1] - was[1];
  const double moved_m2 = dx * dx + dy * dy;
  if (moved_m2 <= limit_m * limit_m) return false;
  const double limit = limit_m + limit_rad * std::sqrt(was[0] * was[0] + was[1] * was[1]);
  return moved_m2 > limit * limit;
}

}  // namespace

void CliqueTree::set_right_side(const ByVariable<Vec3>& gradient, const ByVariable<Vec3>* ignored) {
  for (const int i : marked_) {
    const Clique& c = cliques_[at(i)];
    for (int j = 0; j < c.width; ++j) {
      const int v = c.variables[at(j)];
      for (std::size_t a = 0; a < 3; ++a) {
        x_[v][a] = (ignored != nullptr ? (*ignored)[v][a] : 0.0) - gradient[v][a];
      }
    }
  }
}

double CliqueTree::substitute() {
  ForwardSubstitution run{cliques_, marked_, pointer_to(x_), work_.gathered.data()};
  sparse::run_for_processor(run);
  double sum = 0.0;
  for (const int i : marked_) {
    const Clique& c = cliques_[at(i)];
    for (int j = 0; j < c.width; ++j) {
      const Vec3& y = x_[c.variables[at(j)]];
      sum += y[0] * y[0] + y[1] * y[1] + y[2] * y[2];
    }
  }
  return sum;
}

CliqueTree::Step CliqueTree::solved() {
  const double promised = substitute();
  is_solved_ = true;
  return {promised, ++solves_};
}

CliqueTree::Step CliqueTree::forward(std::span<const int> variables,
                                     const ByVariable<Vec3>& gradient,
                                     const ByVariable<Vec3>& ignored) {
  unmark();
  for (const int v : variables) mark_up(v);
  sort_marked();
  set_right_side(gradient, &ignored);
  return solved();
}

CliqueTree::Step CliqueTree::forward_all(const ByVariable<Vec3>& gradient) {
  unmark();
  mark_all();
  set_right_side(gradient, nullptr);
  return solved();
}

void CliqueTree::propagate([[maybe_unused]] const Step& step, double negligible) {
  assert(is_solved_ && step.number_ == solves_);
  ++last_.number;
  last_.bent.clear();
  last_.bent_cliques.clear();
  last_.before[0] = problem_.nodes[0];
  if (order_.root >= 0) work_.stack.assign(1, order_.root);
  while (!work_.stack.empty()) {
    const int i = work_.stack.back();
    work_.stack.pop_back();
    bend(i, negligible);
  }
  unmark();
}

// Gathers what the rigid motion leaves of the separator's; whether that is worth a bend.
bool CliqueTree::bend_separator(const Clique& c, const RigidMotion& rigid, double negligible) {
  double most = 0.0;
  for (int j = c.width; j < c.rows(); ++j) {
    const int s = c.variables[at(j)];
    double* d = work_.gathered.data() + 3 * at(j);
    if (is_errors(s)) {
      errors_between(last_.before[s], problem_.node(s), d);
    } else {
      offset_of(rigid(last_.before[s]), problem_.nodes[at(s)], d);
    }
    most = std::max(most, size_of(d, problem_.weights[s]));
  }
  return most > negligible;
}

bool CliqueTree::has_moved(const Clique& c, double negligible) const {
  for (int j = c.width; j < c.rows(); ++j) {
    const int s = c.variables[at(j)];
    if (is_errors(s)) continue;
    double d[3];
    offset_of(last_.before[s], problem_.nodes[at(s)], d);
    if (size_of(d, problem_.weights[s]) > negligible) return true;
  }
  return false;
}

void CliqueTree::bend(int clique, double negligible) {
  const Clique& c = cliques_[at(clique)];
  const RigidMotion rigid(last_.before[c.leader], problem_.nodes[at(c.leader)]);
  if (!bend_separator(c, rigid, negligible) && !c.is_marked) {
    if (has_moved(c, negligible)) follow(clique, rigid);
    return;
  }
  settle_clique(clique);
  for (int j = 0; j < c.width; ++j) {
    const Vec3& y = x_[c.variables[at(j)]];
    for (int a = 0; a < 3; ++a) work_.gathered[at(3 * j + a)] = c.is_marked ? y[at(a)] : 0.0;
  }
  BackwardSubstitution run{c, work_.gathered.data()};
  sparse::run_for_processor(run);
  for (int j = 0; j < c.width; ++j) {
    const int v = c.variables[at(j)];
    Node& node = problem_.node(v);
    last_.before[v] = node;
    problem_.save(v, node);
    const double* d = work_.gathered.data() + 3 * at(j);
    node = is_errors(v) ? corrected_errors(node, d) : corrected(rigid(node), d);
    last_.bent.push_back(v);
  }
  last_.bent_cliques.push_back(clique);
  work_.stack.insert(work_.stack.end(), c.children.begin(), c.children.end());
}

void CliqueTree::find_to_relinearise(double limit_m, double limit_rad,
                                     std::vector<int>& variables) const {
  for (const int i : last_.bent_cliques) {
    const Clique& c = cliques_[at(i)];
    const Node& seen_from = problem_.nodes[at(c.variables.back())];
    for (int j = 0; j + 1 < c.rows(); ++j) {
      const int v = c.variables[at(j)];
      // Their part of the residuals is linear.
      if (is_errors(v)) continue;
      double now[3];
      offset_of(seen_from, problem_.nodes[at(v)], now);
      if (!has_left(c.layout.data() + 3 * at(j), now, limit_m, limit_rad)) continue;
      variables.push_back(c.variables[0]);
      break;
    }
  }
}

Eigen::Matrix3d CliqueTree::variance(const std::vector<Response>& responses) {
  unmark();
  for (const Response& response : responses) mark_up(response.variable);
  sort_marked();
  Eigen::Index numbers = 0;
  for (const int m : marked_) numbers += 3 * Eigen::Index{cliques_[at(m)].width};
  Eigen::MatrixX3d Y(numbers, 3);
  for (int a = 0; a < 3; ++a) {
    const auto for_each_number = [&](auto use) {
      for (const int m : marked_) {
        const Clique& c = cliques_[at(m)];
        for (int j = 0; j < c.width; ++j) {
          for (double& x : x_[c.variables[at(j)]]) use(x);
        }
      }
    };
    for_each_number([](double& x) { x = 0.0; });
    for (const auto& [variable, J] : responses) {
      if (variable == 0) continue;
      for (int b = 0; b < 3; ++b) x_[variable][at(b)] += J(a, b);
    }
    substitute();
    Eigen::Index next = 0;
    for_each_number([&](double& x) { Y(next++, a) = x; });
  }
  unmark();
  return Y.transpose() * Y;
}

}  // namespace fathom::incremental_smoother

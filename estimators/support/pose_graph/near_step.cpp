#include <algorithm>
#include <array>

#include "estimators/support/pose_graph/normal_equations.hpp"
#include "estimators/support/sparse/symbolic.hpp"

namespace fathom::pose_graph {
namespace {

// Block products of a factorisation that take as long as an iteration, for each block of the
// factor: measured on the survey of docs/cost.md with 10⁶ keyframes.
constexpr double kProductsPerBlock = 9.0;
// Of the residual, in the norm of the preconditioner, to its first: 10⁻³ of the step.
constexpr double kSettledShare = 1e-6;
// More after one iteration and it takes too many: 2·10⁻³ and 9·10⁻³ are left on surveys of 3·10⁵
// and 10⁶ keyframes, which settle in 2 and 5, and 0.2 in a city of 10⁶, which does not in 11.
constexpr double kFarShare = 0.1;

double dot(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

void add(double factor, const std::vector<double>& v, std::vector<double>& to) {
  for (std::size_t i = 0; i < v.size(); ++i) to[i] += factor * v[i];
}

using Three = std::array<double, 3>;

Three at_position(const std::vector<double>& v, int position) {
  if (position < 0) return {};
  const double* const from = v.data() + 3 * at(position);
  return {from[0], from[1], from[2]};
}

// to += H own + X other, H by its upper triangle.
template <bool kTransposed>
void add_products(const std::array<double, 6>& H, const std::array<double, 9>& X, const Three& own,
                  const Three& other, double* to) {
  constexpr std::array<std::array<std::size_t, 3>, 3> kUpper{{{0, 1, 2}, {1, 3, 4}, {2, 4, 5}}};
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t j = 0; j < 3; ++j) {
      to[i] += H[kUpper[i][j]] * own[j] + X[kTransposed ? 3 * j + i : 3 * i + j] * other[j];
    }
  }
}

}  // namespace

int NormalEquations::iterations_worth_a_factor() const {
  if (!has_factor_ || !shared_.empty()) return 0;
  const sparse::Symbolic& symbolic = factor_.symbolic();
  if (symbolic.panel_blocks == 0) return 0;  // chains are all there is
  return static_cast<int>(sparse::multiplications_of(symbolic) /
                          (kProductsPerBlock * static_cast<double>(symbolic.panel_blocks)));
}

void NormalEquations::multiply(std::span<const Node> nodes, std::span<const PairTerms> given,
                               const std::vector<double>& v, std::vector<double>& to) const {
  std::fill(to.begin(), to.end(), 0.0);
  parts_.for_each([&](std::size_t e, const auto& part) {
    const Targets& target = targets_[e];
    const auto add_edge = [&](const PairTerms& t) {
      const Three from = at_position(v, target.from);
      const Three end = at_position(v, target.to);
      if (part.has(target.from)) {
        add_products<false>(t.H_from, t.H_cross, from, end, to.data() + 3 * at(target.from));
      }
      if (part.has(target.to)) {
        add_products<true>(t.H_to, t.H_cross, end, from, to.data() + 3 * at(target.to));
      }
    };
    if (e < given.size()) return add_edge(given[e]);
    if (loss_.leaves_out(e)) return;
    EdgeTerms t = linearise_edge(edges_[e], nodes);
    loss_.apply(e, false, t);
    add_edge(pair_terms<Hessian::gauss_newton>(t));
  });
}

std::optional<double> NormalEquations::solve_near(std::span<const Node> nodes, int most_iterations,
                                                  std::span<const PairTerms> given) {
  const double cost = differentiate(nodes, given);
  std::fill(step_.begin(), step_.end(), 0.0);
  std::vector<double> residual(step_.size());
  for (std::size_t i = 0; i < residual.size(); ++i) residual[i] = -gradient_[i];
  std::vector<double> solved = residual;
  factor_.solve(solved.data());
  std::vector<double> direction = solved;
  std::vector<double> product(step_.size());
  const double first = dot(residual, solved);
  double size = first;
  for (int i = 0; i < most_iterations; ++i) {
    multiply(nodes, given, direction, product);
    const double curvature = dot(direction, product);
    if (!(curvature > 0.0)) return {};
    add(size / curvature, direction, step_);
    add(-size / curvature, product, residual);
    solved = residual;
    factor_.solve(solved.data());
    const double next = dot(residual, solved);
    if (next <= kSettledShare * first) return cost;
    if (i == 0 && next > kFarShare * first) return {};
    for (std::size_t k = 0; k < direction.size(); ++k) {
      direction[k] = solved[k] + next / size * direction[k];
    }
    size = next;
  }
  return {};
}

}  // namespace fathom::pose_graph

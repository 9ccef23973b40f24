#include "estimators/support/pose_graph/solver.hpp"

#include <cmath>
#include <optional>
#include <type_traits>

#include "estimators/support/pose_graph/positions.hpp"

namespace fathom::pose_graph {
namespace {

template <class Equations>
class Minimiser {
 public:
  Minimiser(Equations& equations, std::vector<Node>& nodes, const SolveLimits& limits,
            const SolverTuning& tuning, Hessian first)
      : equations_(equations),
        nodes_(nodes),
        limits_(limits),
        tuning_(tuning),
        hessian_(first),
        newton_below_(tuning.newton_below) {}

  SolveResult run() {
    result_.cost = linearise(nodes_);
    result_.outcome = Outcome::iteration_limit;
    if (!std::isfinite(result_.cost)) {
      result_.outcome = Outcome::numerical_failure;
      return result_;
    }
    while (result_.iterations < limits_.max_iterations) {
      ++result_.iterations;
      if (!take_step()) break;
    }
    finish();
    return result_;
  }

 private:
  double linearise(const std::vector<Node>& nodes) {
    return equations_.linearise(nodes, hessian_, damping_);
  }

  // False where the solve has ended.
  bool take_step() {
    rise_ = 0.0;
    if (!factorise()) return raise_damping();
    equations_.solve_step();
    const double promised = equations_.predicted_decrease();
    if (!std::isfinite(promised)) return raise_damping();
    equations_.move(nodes_, trial_);
    const bool is_last = is_small(promised) && damping_ == 0.0;
    if (is_last) {
      if (hessian_ == Hessian::exact || is_indefinite_here_) {
        end_with(trial_);
        return false;
      }
      hessian_ = Hessian::exact;
    } else if (ends_with_chords(promised)) {
      return false;
    } else if (promised < newton_below_ * result_.cost) {
      hessian_ = Hessian::exact;
    }
    double cost = linearise(trial_);
    rise_ = cost - result_.cost;
    // What a step of less than the tolerance gains may be less than the rounding of F.
    if (is_no_rise(cost, is_last ? limits_.tolerance : 0.0) || follow_headings(cost)) {
      nodes_.swap(trial_);
      result_.cost = cost;
      lower_damping();
      return true;
    }
    return raise_damping();
  }

  bool is_small(double promised) const {
    return promised <= limits_.tolerance * result_.cost || promised <= tuning_.least_promise_chi2 ||
           equations_.step_is_small(nodes_, limits_.tolerance);
  }

  // More steps with the factor of this one, from its end on, as long as each promises far less than
  // the one before. Whether that ended the solve; if not, `trial_` is where they led.
  bool ends_with_chords(double promised) {
    if (hessian_ != Hessian::exact || is_indefinite_here_ || damping_ != 0.0) return false;
    if (promised > tuning_.chord_below * result_.cost) return false;
    if (result_.iterations == limits_.max_iterations) return false;
    const double enough = tuning_.chord_share * limits_.tolerance * result_.cost;
    while (true) {
      const double cost = equations_.differentiate(trial_);
      if (!is_no_rise(cost)) return false;
      equations_.solve_step();
      const double left = equations_.predicted_decrease();
      if (!(left <= tuning_.chord_contraction * promised)) return false;
      equations_.move(trial_, chord_);
      trial_.swap(chord_);
      if (left <= std::max(enough, tuning_.least_promise_chi2)) {
        ++result_.iterations;
        nodes_.swap(chord_);
        result_.cost = cost;
        end_with(trial_);
        return true;
      }
      promised = left;
    }
  }

  // At the end of the last step; the estimate before it stays at hand.
  void end_with(std::vector<Node>& last) {
    result_.outcome = Outcome::converged;
    nodes_.swap(last);
    before_last_ = &last;
  }

  // Of an exact Hessian that is not positive definite, its Gauss-Newton part is taken.
  bool factorise() {
    const bool done = equations_.factorise(sparse::Inertia::positive);
    is_indefinite_here_ = false;
    if (hessian_ != Hessian::exact) return done;
    if (done) {
      if (damping_ == 0.0) result_.is_local_minimum = true;
      return true;
    }
    is_indefinite_here_ = true;
    newton_below_ *= tuning_.after_indefinite;
    result_.is_local_minimum = false;
    hessian_ = Hessian::gauss_newton;
    linearise(nodes_);
    return equations_.factorise(sparse::Inertia::positive);
  }

  bool is_no_rise(double cost, double share = 0.0) const {
    return cost <=
           result_.cost * (1.0 + std::max(share, tuning_.rounding_share)) + tuning_.rounding_chi2;
  }

  // A step that failed, again with the positions that suit its headings.
  bool follow_headings(double& cost) {
    if (!find_positions()) return false;
    cost = linearise(trial_);
    return is_no_rise(cost);
  }

  bool find_positions() {
    if constexpr (std::is_same_v<Equations, NormalEquations>) {
      if (!positions_) {
        positions_.emplace(equations_.factor(), equations_.edges(), equations_.loss());
      }
      return positions_->solve(trial_);
    } else {
      return equations_.follow_headings(trial_);
    }
  }

  bool raise_damping() {
    damping_ = std::max(tuning_.first_damping, tuning_.damping_increase * damping_);
    if (damping_ > tuning_.largest_damping) {
      result_.outcome = is_at_jump() ? Outcome::iteration_limit : Outcome::numerical_failure;
      return false;
    }
    hessian_ = Hessian::gauss_newton;
    linearise(nodes_);
    return true;
  }

  // Where a heading residual passes ±π, full covariances make F jump. The least F may be beside a
  // jump: then the shortest step makes it rise by far more than rounding does.
  bool is_at_jump() const {
    return std::isfinite(rise_) && rise_ > tuning_.jump_share * result_.cost + tuning_.jump_chi2;
  }

  void lower_damping() {
    if (damping_ == 0.0) return;
    damping_ = damping_ > tuning_.least_damping ? tuning_.damping_decrease * damping_ : 0.0;
    linearise(nodes_);
  }

  void finish() {
    const double cost = equations_.differentiate(nodes_);
    // A step that promises next to nothing may be long, along what weak measurements leave open:
    // strong ones then notice its second order.
    if (before_last_ != nullptr && !is_no_rise(cost, limits_.tolerance)) {
      nodes_.swap(*before_last_);
      result_.cost = equations_.differentiate(nodes_);
    } else {
      result_.cost = cost;
    }
    result_.gradient_norm = equations_.gradient_norm();
    // What was found on the way says nothing of where it stopped.
    if (result_.outcome != Outcome::converged) result_.is_local_minimum.reset();
    if (!std::isfinite(result_.cost)) result_.outcome = Outcome::numerical_failure;
  }

  Equations& equations_;
  std::vector<Node>& nodes_;
  SolveLimits limits_;
  SolverTuning tuning_;
  SolveResult result_;
  double rise_ = 0.0;  ///< of F by the last step; 0 where there was none
  std::vector<Node> trial_;
  std::vector<Node> chord_;
  std::vector<Node>* before_last_ = nullptr;  ///< of a solve that has converged
  std::optional<PositionProblem> positions_;
  Hessian hessian_;
  double damping_ = 0.0;
  bool is_indefinite_here_ = false;  ///< the exact Hessian, at the present estimate
  double newton_below_;
};

// The first step of a large graph by conjugate gradients, where an estimate nearby has been
// factored. F may rise over it, so what follows counts if it ends in a minimum below.
template <class Equations>
SolveResult minimise_by(Equations& equations, std::vector<Node>& nodes, const SolveLimits& limits,
                        const SolverTuning& tuning, Hessian first) {
  const auto run = [&](std::vector<Node>& start, int max_iterations, Hessian hessian) {
    const SolveLimits left{max_iterations, limits.tolerance};
    return Minimiser<Equations>(equations, start, left, tuning, hessian).run();
  };
  const bool is_worth_it = first == Hessian::gauss_newton && limits.max_iterations > 1 &&
                           equations.iterations_worth_a_factor() >= tuning.least_near_iterations;
  std::optional<double> cost;
  if (is_worth_it) cost = equations.solve_near(nodes, equations.iterations_worth_a_factor());
  if (cost) {
    const bool is_near = equations.predicted_decrease() < tuning.newton_below * *cost;
    std::vector<Node> moved;
    equations.move(nodes, moved);
    SolveResult result =
        run(moved, limits.max_iterations - 1, is_near ? Hessian::exact : Hessian::gauss_newton);
    ++result.iterations;
    const bool is_minimum = result.outcome == Outcome::converged && result.is_local_minimum == true;
    if (is_minimum && result.cost <= *cost) {
      nodes.swap(moved);
      return result;
    }
  }
  return run(nodes, limits.max_iterations, first);
}

}  // namespace

SolveResult minimise(NormalEquations& equations, std::vector<Node>& nodes,
                     const SolveLimits& limits, const SolverTuning& tuning, Hessian first) {
  return minimise_by(equations, nodes, limits, tuning, first);
}

SolveResult minimise(ChainEquations& equations, std::vector<Node>& nodes, const SolveLimits& limits,
                     Hessian first) {
  return minimise_by(equations, nodes, limits, {}, first);
}

}  // namespace fathom::pose_graph

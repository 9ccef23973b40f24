#include "groups.hpp"

namespace fathom {
namespace {

std::optional<double> cost_at_estimate(const JudgedRun& run) {
  return chi2(run.facts.log, run.facts.estimate);
}

std::optional<double> gap(const JudgedRun& run) {
  if (!run.facts.chi2_optimum) return std::nullopt;
  return chi2(run.facts.log, run.facts.estimate) - *run.facts.chi2_optimum;
}

}  // namespace

std::vector<Metric> optimum_metrics() {
  return {
      {"chi2", "F", "", Better::lower, "F of the whole log at the estimate", cost_at_estimate},
      {"chi2_initial", "F at the start", "", Better::neither,
       "F at dead reckoning, or at the file's vertices with --init file; of a batch solve over "
       "holes, or with a free start, where it begins",
       run_field(&Run::chi2_initial)},
      {"chi2_used", "F of what was used", "", Better::neither,
       "cost of what was used: rejected loops left out, loss applied", run_field(&Run::chi2_used)},
      {"chi2_optimum", "F at the optimum", "", Better::neither,
       "the least F that a batch solve of the log reaches from dead reckoning or from the estimate",
       [](const JudgedRun& run) { return run.facts.chi2_optimum; }},
      {"chi2_gap", "F above the optimum", "", Better::lower, "chi2 - chi2_optimum", gap},
      {"gradient_norm", "gradient of F", "", Better::lower,
       "largest absolute element (m, rad) of the gradient of F at the estimate, the last solve's; "
       "of solvers that report it",
       run_field(&Run::gradient_norm)},
      {"is_local_minimum", "at a local minimum", "", Better::higher,
       "1 where the exact Hessian of F is positive definite at the estimate, else 0; likewise",
       run_field(&Run::is_local_minimum)},
      {"iterations", "iterations", "", Better::lower,
       "linearisations (filters) or solver iterations, summed over updates",
       run_field(&Run::iterations)},
  };
}

}  // namespace fathom

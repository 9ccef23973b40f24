#include "groups.hpp"

namespace fathom {
namespace {

using Value = std::optional<double>;

Value cost_at_estimate(const JudgedRun& run) {
  return cost_of(run.facts);
}

Value gap(const JudgedRun& run) {
  if (!run.facts.chi2_optimum) return std::nullopt;
  return cost_of(run.facts) - *run.facts.chi2_optimum;
}

// Of a log that tells what its registrations share, whatever the estimator makes of it.
template <RegistrationErrors kErrors>
Value cost_with(const JudgedRun& run) {
  if (!run.facts.log.tells_shared_errors()) return std::nullopt;
  return chi2(run.facts.log, run.facts.estimate, kErrors);
}

Value estimates_shared_errors(const JudgedRun& run) {
  if (run.facts.run == nullptr || !run.facts.log.tells_shared_errors()) return std::nullopt;
  return run.facts.run->errors == RegistrationErrors::shared ? 1.0 : 0.0;
}

}  // namespace

double cost_of(const RunFacts& facts) {
  const auto errors = facts.run != nullptr ? facts.run->errors : RegistrationErrors::independent;
  return chi2(facts.log, facts.estimate, errors);
}

std::vector<Metric> optimum_metrics() {
  return {
      {"chi2", "F", "", Better::lower,
       "F of the whole log at the estimate; with the errors that registrations share, where the "
       "estimator estimates them",
       cost_at_estimate},
      {"chi2_independent", "F, independent", "", Better::neither,
       "where the log tells shared errors: F of every estimator as if registrations were "
       "independent",
       cost_with<RegistrationErrors::independent>},
      {"chi2_shared", "F, shared errors", "", Better::neither,
       "likewise: F of every estimator with the errors that registrations share",
       cost_with<RegistrationErrors::shared>},
      {"estimates_shared_errors", "estimates shared errors", "", Better::neither,
       "likewise: 1 where the estimator estimates them, else 0", estimates_shared_errors},
      {"chi2_initial", "F at the start", "", Better::neither,
       "F at dead reckoning, or at the file's vertices with --init file; of a batch solve over "
       "holes, or with a free start, where it begins",
       run_field(&Run::chi2_initial)},
      {"chi2_used", "F of what was used", "", Better::neither,
       "cost of what was used: rejected loops left out, loss applied", run_field(&Run::chi2_used)},
      {"chi2_optimum", "F at the optimum", "", Better::neither,
       "the least F, as of chi2, that a batch solve of the log reaches from dead reckoning or from "
       "the estimate",
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

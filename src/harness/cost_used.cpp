#include "cost_used.hpp"

#include "fathom/geometry/covariance.hpp"

namespace fathom {

double absolute_cost_used(const MeasurementLog& log, const Estimate& estimate, const Run& result) {
  double sum = 0.0;
  if (!log.start().is_fixed()) sum += chi2(log.start().measurement(), result.trajectory[0]);
  std::size_t next = 0;
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) {
      if (result.absolute[next++].fate != LoopFate::used) continue;
      sum += estimate.loss(chi2(z, result.trajectory[k]), rank_of(z.information));
    }
  }
  return sum;
}

// Decisions stand in the order of the log.
double cost_used(const MeasurementLog& log, const Estimate& estimate, const Run& result) {
  double sum = result.absolute_chi2_used;
  if (result.errors == RegistrationErrors::shared && log.tells_shared_errors()) {
    return sum + shared_chi2_used(log, result.trajectory, result.loop_weights,
                                  [&](double value) { return estimate.loss(value); });
  }
  std::size_t loop = 0;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    const auto chi2_of = [&](const RelativePose& z) {
      return chi2(z, result.trajectory[z.from], result.trajectory[z.to]);
    };
    if (!arrival.step.is_hole) sum += chi2_of(arrival.step);
    for (const RelativePose& z : arrival.registrations) {
      if (result.loops[loop++].fate == LoopFate::used) sum += estimate.loss(chi2_of(z));
    }
  }
  return sum;
}

}  // namespace fathom

// What an estimator made of absolute measurements, and holes. All absent of a log without any.

#include <algorithm>

#include "fathom/geometry/covariance.hpp"
#include "groups.hpp"

namespace fathom {
namespace {

using Value = std::optional<double>;

// Of runs over a log that has absolute measurements.
template <class Of>
auto with_absolute(Of of) {
  return [of](const JudgedRun& run) -> Value {
    if (run.facts.run == nullptr || run.facts.log.absolute_count() == 0) return std::nullopt;
    return of(run);
  };
}

auto count_of_absolute(LoopFate fate) {
  return with_absolute([fate](const JudgedRun& run) -> Value {
    return static_cast<double>(
        std::ranges::count(run.facts.run->absolute, fate, &AbsoluteDecision::fate));
  });
}

Value given(const JudgedRun& run) {
  return static_cast<double>(run.facts.log.absolute_count());
}

Value absolute_kept(const JudgedRun& run) {
  return static_cast<double>(std::ranges::count_if(run.facts.run->absolute_weights, is_kept));
}

Value mean_absolute_nis(const JudgedRun& run) {
  double sum = 0.0;
  int degrees = 0;
  std::size_t next = 0;
  for (std::size_t k = 0; k < run.facts.log.size(); ++k) {
    for (const AbsolutePose& z : run.facts.log.arrival(k).absolute) {
      const AbsoluteDecision& decision = run.facts.run->absolute[next++];
      if (decision.fate != LoopFate::used || !decision.nis) continue;
      sum += *decision.nis;
      degrees += rank_of(z.information);
    }
  }
  if (degrees == 0) return std::nullopt;
  return sum / degrees;
}

Value mean_absolute_nis_truth(const JudgedRun& run) {
  const RunFacts& facts = run.facts;
  if (!facts.ground_truth) return std::nullopt;
  double sum = 0.0;
  int degrees = 0;
  for (std::size_t k = 0; k < facts.log.size(); ++k) {
    for (const AbsolutePose& z : facts.log.arrival(k).absolute) {
      sum += chi2(z, (*facts.ground_truth)[k]);
      degrees += rows_of(z.information).rank;
    }
  }
  if (degrees == 0) return std::nullopt;
  return sum / degrees;
}

// With an uncertain start, too: it is no edge either.
bool has_world(const JudgedRun& run) {
  const MeasurementLog& log = run.facts.log;
  return run.facts.run != nullptr && (log.absolute_count() > 0 || !log.start().is_fixed());
}

Value cost(const JudgedRun& run) {
  if (!has_world(run)) return std::nullopt;
  return absolute_chi2(run.facts.log, run.facts.estimate);
}

Value cost_used(const JudgedRun& run) {
  if (!has_world(run)) return std::nullopt;
  return run.facts.run->absolute_chi2_used;
}

Value holes(const JudgedRun& run) {
  const std::size_t count = run.facts.log.hole_count();
  if (run.facts.run == nullptr || count == 0) return std::nullopt;
  return static_cast<double>(count);
}

// Of a log of steps and registrations alone it is three times the registrations.
Value degrees(const JudgedRun& run) {
  const MeasurementLog& log = run.facts.log;
  if (!holes(run) && !has_world(run)) return std::nullopt;
  return degrees_of_freedom(log);
}

}  // namespace

std::vector<Metric> absolute_metrics() {
  return {
      {"absolute_measurements", "absolute measurements", "", Better::neither,
       "of the log: headings, positions, poses", with_absolute(given)},
      {"absolute_used", "absolute used", "", Better::neither, "absolute measurements used",
       count_of_absolute(LoopFate::used)},
      {"absolute_rejected", "absolute rejected", "", Better::neither,
       "absolute measurements refused by the gate", count_of_absolute(LoopFate::rejected)},
      {"absolute_lost", "absolute lost", "", Better::lower,
       "absolute measurements let through by the gate, but their update failed",
       count_of_absolute(LoopFate::lost)},
      {"absolute_kept", "absolute kept", "", Better::neither,
       "absolute measurements that weigh more than one half in the end",
       with_absolute(absolute_kept)},
      {"mean_nis_absolute", "mean NIS of absolute measurements", "", Better::neither,
       "NIS of the used absolute measurements over its degrees of freedom, the rank of each; 1 "
       "expected",
       with_absolute(mean_absolute_nis)},
      {"mean_nis_truth_absolute", "mean NIS against truth, absolute", "", Better::neither,
       "the same of the log's absolute measurements at ground truth; 1 expected, above: their "
       "covariances are too small",
       with_absolute(mean_absolute_nis_truth)},
      {"absolute_chi2", "F of absolute measurements", "", Better::neither,
       "the part of F that is of absolute measurements and of an uncertain start", cost},
      {"absolute_chi2_used", "F of absolute measurements used", "", Better::neither,
       "the same of chi2_used: rejected ones left out, loss applied", cost_used},
      {"holes", "holes", "", Better::neither, "steps of the log that were not measured", holes},
      {"degrees_of_freedom", "degrees of freedom", "", Better::neither,
       "of F at its minimum; absent where it is three times the registrations", degrees},
  };
}

}  // namespace fathom

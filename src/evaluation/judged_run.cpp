#include "fathom/evaluation/judged_run.hpp"

#include <utility>

namespace fathom {

JudgedRun judge(RunFacts facts) {
  JudgedRun run{std::move(facts), std::nullopt, std::nullopt};
  if (!run.facts.ground_truth) return run;
  const std::span<const Pose> truth = *run.facts.ground_truth;
  run.accuracy = accuracy(run.facts.estimate, truth, run.facts.options.alignment);
  if (run.facts.covariances) {
    run.consistency = consistency(run.facts.estimate, truth, *run.facts.covariances);
  }
  return run;
}

}  // namespace fathom

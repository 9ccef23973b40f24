#include "fathom/evaluation/judged_run.hpp"

#include <utility>

namespace fathom {

JudgedRun judge(RunFacts facts) {
  JudgedRun run{std::move(facts), std::nullopt, std::nullopt, std::nullopt, std::nullopt};
  if (run.facts.held_out != nullptr) run.held_out = held_out_errors(*run.facts.held_out);
  if (!run.facts.ground_truth) return run;
  const std::span<const Pose> truth = *run.facts.ground_truth;
  run.accuracy = accuracy(run.facts.estimate, truth, run.facts.options.alignment);
  if (!run.facts.frame_ground_truth.empty()) {
    run.frame_accuracy = accuracy(run.facts.frame_estimate, run.facts.frame_ground_truth,
                                  run.facts.options.alignment);
  }
  if (run.facts.covariances) {
    const bool is_held = run.facts.log.start().is_fixed();
    run.consistency = consistency(run.facts.estimate, truth, *run.facts.covariances,
                                  is_held ? Alignment::origin : Alignment::none);
  }
  return run;
}

}  // namespace fathom

#include "held_out_run.hpp"

#include <utility>

#include "fathom/measurements/held_out_loops.hpp"

namespace fathom {

void hold_out(Recording& recording, const MetricOptions& options, const TrialNoise& noise) {
  if (options.held_out_loops == 0.0) return;
  recording.is_held_out = draw_held_out(recording.log, recording.is_false_loop,
                                        options.held_out_loops, noise.seed, noise.trial);
}

std::optional<HeldOutLoops> held_out_loops(const Recording& recording,
                                           const MetricOptions& options) {
  if (recording.is_held_out.empty()) return std::nullopt;
  HeldOutLoops held_out;
  held_out.loops = held_out_of(recording.log, recording.is_held_out);
  held_out.tested =
      evenly_spaced(held_out.loops.size(), static_cast<std::size_t>(options.held_out_pairs));
  return held_out;
}

std::vector<KeyframePair> tested_pairs(const HeldOutLoops& held_out) {
  std::vector<KeyframePair> pairs;
  for (const std::size_t place : held_out.tested) {
    pairs.push_back({held_out.loops[place].from, held_out.loops[place].to});
  }
  return pairs;
}

std::optional<HeldOutLoops> held_out_run(const Recording& recording, const MetricOptions& metrics,
                                         const ReplayOptions& options, const ReplayOfLog& replay) {
  std::optional<HeldOutLoops> held_out = held_out_loops(recording, metrics);
  if (!held_out || held_out->loops.empty()) return held_out;
  ReplayOptions asked;
  asked.mode = options.mode;
  asked.start = options.start;
  asked.progress = options.progress;
  asked.covariances = false;
  const auto tested = static_cast<double>(held_out->tested.size());
  asked.motions = {{MotionsOver::held_out, tested, tested_pairs(*held_out)}};
  Run run = replay(log_without(recording.log, recording.is_held_out), asked);
  if (!is_done(run.outcome)) return std::nullopt;
  held_out->estimate = std::move(run.trajectory);
  held_out->covariances = std::move(run.motions.front().covariances);
  return held_out;
}

}  // namespace fathom

#pragma once

#include <chrono>
#include <memory>
#include <utility>

#include "fathom/harness/recording.hpp"
#include "fathom/harness/run_record.hpp"
#include "held_out_run.hpp"

namespace fathom {

/// A recording with what all its runs are judged by, and a clock for what they take.
struct RecordedTrial {
  std::shared_ptr<const Recording> recording;
  RecordingFacts facts;

  RecordedTrial() = default;
  explicit RecordedTrial(Recording made)
      : recording(std::make_shared<const Recording>(std::move(made))) {}

  /// Since it was made, or since the last call.
  double lap_s() {
    const auto before = std::exchange(last_, Clock::now());
    return std::chrono::duration<double>(last_ - before).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point last_ = Clock::now();
};

/// As of Recorder::record, with the loops that second runs are not given.
inline RecordedTrial record_trial(const Recorder& recorder, const Configuration& configuration,
                                  const CandidateReference& reference,
                                  const EstimatorRegistry& registry, const TrialNoise& noise,
                                  const FrontEndProgressCallback& progress) {
  Recording recording = recorder.record(configuration, reference, registry, noise, progress);
  hold_out(recording, configuration.study.evaluation, noise);
  return RecordedTrial(std::move(recording));
}

}  // namespace fathom

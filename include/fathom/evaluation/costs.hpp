#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace fathom {

/// What an estimate cost. Times are wall times of the estimator's calls alone, on this thread; of
/// what programs do for it their processor time, and their peak of memory. Whatever is measured of
/// a run's cost is a member here with its entry in each(); from these are made the metrics, the
/// message of a run in a process of its own, and with the metrics store, tables, page and Python.
struct Costs {
  std::vector<double> update_ms;
  std::vector<double> add_ms;
  /// Per keyframe from 1 on; empty where not asked for or not to be had.
  std::vector<double> newest_covariance_ms;
  double total_ms = 0.0;
  std::optional<double> candidate_covariance_ms;
  double cpu_ms = 0.0;
  std::optional<double> covariance_ms;
  std::optional<double> start_up_ms;
  std::optional<std::int64_t> memory_bytes;

  /// For each member, in the order of the metrics: visit(name, label, unit, what it is, member). A
  /// list is one of calls, and its text says of which.
  template <class Visit>
  static void each(Visit&& visit) {
    visit("update_ms", "update time", "ms",
          "updates: calls with registrations, without the keyframe's own, or the batch solve",
          &Costs::update_ms);
    visit("add_ms", "add time", "ms", "the calls that add a keyframe", &Costs::add_ms);
    visit("newest_covariance_ms", "time of the newest covariance", "ms",
          "the covariance of the newest pose, asked for after every keyframe's update",
          &Costs::newest_covariance_ms);
    visit("total_ms", "estimate, time", "ms",
          "wall time of all calls for the estimate: keyframes, updates, and covariances that gates "
          "or its own loop candidates ask for",
          &Costs::total_ms);
    visit("candidate_covariance_ms", "candidates' covariance time", "ms",
          "wall time of the covariances that its own loop candidates ask for, a part of total_ms",
          &Costs::candidate_covariance_ms);
    visit("cpu_ms", "CPU time", "ms", "CPU time of its threads over the same calls",
          &Costs::cpu_ms);
    visit("covariance_ms", "covariance time", "ms",
          "wall time of the covariances of all keyframes, asked for once, at the end",
          &Costs::covariance_ms);
    visit("start_up_ms", "start-up", "ms",
          "CPU time of the start-up of a program that does the work, no part of the others",
          &Costs::start_up_ms);
    visit("memory_bytes", "memory", "bytes",
          "peak heap of the estimator; of a program all that it had in use", &Costs::memory_bytes);
  }
};

}  // namespace fathom

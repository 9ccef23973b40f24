#pragma once

#include <algorithm>
#include <chrono>
#include <limits>

#include "fathom/core/program.hpp"
#include "fathom/core/workers.hpp"
#include "fathom/evaluation/costs.hpp"

namespace fathom {

/// Wall and processor time of one call of the estimator, added to the totals. Of what it lets
/// programs do only their processor time counts: pipes and files are not theirs.
class CallTimer {
 public:
  using Clock = std::chrono::steady_clock;

  explicit CallTimer(Costs& costs) : costs_(costs) {}

  /// Wall time since it was made, ms.
  double stop() const {
    double elapsed_ms = milliseconds_since(start_);
    const double measured_ms = processor_ms();
    double cpu_ms = std::max(0.0, measured_ms - processor_ms_of_none());
    const ProgramWork& work = program_work();
    if (work.waited_s != work_.waited_s) {
      const double by_program_ms = 1e3 * (work.processor_s - work_.processor_s);
      elapsed_ms += by_program_ms - 1e3 * (work.waited_s - work_.waited_s);
      cpu_ms += by_program_ms - 1e3 * (work.own_s - work_.own_s);
      const double start_up_ms = 1e3 * (work.start_up_s - work_.start_up_s);
      costs_.start_up_ms = costs_.start_up_ms.value_or(0.0) + start_up_ms;
    }
    costs_.total_ms += elapsed_ms;
    costs_.cpu_ms += cpu_ms;
    return elapsed_ms;
  }

  static double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
  }

 private:
  double processor_ms() const { return 1e3 * (thread_processor_seconds() - cpu_start_s_); }

  // The system takes some 300 ns to say the processor time of a thread, and a log has thousands of
  // calls that take no longer. The least of many, so that no call is made cheaper than it is.
  static double processor_ms_of_none() {
    static const double of_none = [] {
      constexpr int kTries = 200;
      Costs none;
      double least = std::numeric_limits<double>::infinity();
      for (int i = 0; i < kTries; ++i) {
        const CallTimer timer(none);
        milliseconds_since(timer.start_);
        least = std::min(least, timer.processor_ms());
      }
      return least;
    }();
    return of_none;
  }

  Costs& costs_;
  ProgramWork work_ = program_work();
  double cpu_start_s_ = thread_processor_seconds();
  Clock::time_point start_ = Clock::now();
};

}  // namespace fathom

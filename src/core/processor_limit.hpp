#pragma once

#include <csignal>
#include <string>
#include <sys/resource.h>

#include "fathom/core/environment_error.hpp"

namespace fathom {

/// Throws EnvironmentError where a process that a signal ended had taken all the processor time
/// that the system gives one (`ulimit -t`): it says nothing of what was run.
inline void refuse_processor_limit(int signal, double used_s) {
  // The system counts by the ticks of its clock, so that it may have taken less.
  constexpr double kLeastShare = 0.8;
  rlimit limit{};
  ::getrlimit(RLIMIT_CPU, &limit);
  if ((signal != SIGXCPU && signal != SIGKILL) || limit.rlim_cur == RLIM_INFINITY ||
      used_s < kLeastShare * static_cast<double>(limit.rlim_cur)) {
    return;
  }
  throw EnvironmentError("a run was ended by the system, as 'ulimit -t' gives a process " +
                         std::to_string(limit.rlim_cur) + " s of processor time; raise it");
}

}  // namespace fathom

#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "fathom/harness/replay.hpp"

namespace fathom {

/// What a run may take. The most memory is that of its address space beyond what this process has.
struct ProcessLimits {
  double time_s = 0.0;
  std::int64_t memory_bytes = 0;
};

/// As of replay, in a child process, to the last bit. Cost is measured there. The child is a fork
/// of this process at this moment. Other threads may run; a lock that one of them holds then, of a
/// library that does not know of forks, stays locked in the child, which ends at its time limit.
/// What it prints is kept from both outputs.
///
/// A crash, a hang or too much memory is an outcome, with its signal and the last lines that the
/// child printed as the fault. No process is left behind: the child's process group is killed at
/// the end, and the child ends with the thread that called. A process that leaves that group
/// escapes.
///
/// Throws InputError as replay does, and where the system refuses a process. What `progress` throws
/// ends the child.
Run isolated_replay(const MeasurementLog& log, const EstimatorEntry& entry,
                    const EstimatorValues& values, const ReplayOptions& options,
                    const ProcessLimits& limits);

/// The outcome of this name, if it is one of a process; nothing of one that a replay has.
std::optional<Outcome> end_of_process(const std::string& name);

}  // namespace fathom

#include "child_failure.hpp"

#include <csignal>
#include <cstring>
#include <fmt/format.h>
#include <sstream>

namespace fathom {

ChildFailure failure_of(const ChildEnd& end, const ChildLimits& limits) {
  ChildFailure failure;
  if (end.is_late) {
    std::ostringstream seconds;
    seconds << limits.time_s;
    failure = {Outcome::timed_out, "was killed after " + seconds.str() + " s"};
  } else if (end.signal == SIGKILL) {
    failure = {Outcome::out_of_memory,
               "was killed by signal 9, as the system does where it has no memory left"};
  } else if (end.exit_status == kNoMemoryStatus) {
    failure = {Outcome::out_of_memory,
               "found no memory within " + std::to_string(limits.memory_bytes >> 20) + " MiB"};
  } else if (end.signal != 0) {
    failure = {Outcome::crashed,
               fmt::format("was ended by signal {} ({})", end.signal, ::strsignal(end.signal))};
  } else {
    failure = {Outcome::crashed,
               "ended its process itself, with status " + std::to_string(end.exit_status)};
  }
  if (!end.last_lines.empty()) failure.how += "; it printed last: " + end.last_lines;
  return failure;
}

}  // namespace fathom

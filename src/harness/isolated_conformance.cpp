// One clause of the contract in a process of its own.

#include <optional>

#include "child_failure.hpp"
#include "fathom/harness/conformance.hpp"

namespace fathom {

ConformanceVerdict isolated_conformance_of(const EstimatorEntry& estimator,
                                           const std::string& clause, const ProcessLimits& limits) {
  std::optional<ConformanceVerdict> verdict;
  const ChildLimits child{limits.time_s, limits.memory_bytes};
  ChildEnd end;
  try {
    end = run_child(
        [&](const MessagePipe& parent) {
          const ConformanceVerdict found = conformance_of(estimator, clause);
          parent.send(static_cast<char>('0' + static_cast<int>(found.conformity)), found.how);
        },
        child,
        [&](char kind, const std::string& how) {
          if (kind >= '0' && kind <= '2') verdict = {static_cast<Conformity>(kind - '0'), how};
        });
  } catch (const DamagedMessage& damage) {
    return {Conformity::broken, std::string("its process damaged what it sent: ") + damage.what()};
  }
  if (verdict && end.signal == 0 && end.exit_status == 0) return *verdict;
  return {Conformity::broken, "its process " + failure_of(end, child).how};
}

}  // namespace fathom

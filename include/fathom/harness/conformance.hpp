#pragma once

#include <string>
#include <vector>

#include "fathom/estimation/registry.hpp"
#include "fathom/harness/isolated_replay.hpp"

/// The contract of an estimator (Estimator in fathom/estimation/estimator.hpp), clause by clause,
/// to hold any estimator against.
namespace fathom {

struct ConformanceClause {
  std::string name;  ///< "rotated_world"
  std::string rule;  ///< one line: what must hold
};

/// `not_applicable`: the clause is about a mode or an option that the estimator does not have.
enum class Conformity { kept, broken, not_applicable };

struct ConformanceVerdict {
  Conformity conformity = Conformity::kept;
  /// One line. Of a broken clause what was found and what was expected, of one that does not apply
  /// the reason; else empty.
  std::string how;
};

/// All clauses, from the simple to the demanding: one that breaks the first breaks others, too.
const std::vector<ConformanceClause>& conformance_clauses();

/// Holds an estimator against one clause. Whatever it throws breaks the clause. An estimator that
/// crashes or does not come back takes the process with it. Throws InputError on an unknown clause.
ConformanceVerdict conformance_of(const EstimatorEntry& estimator, const std::string& clause);

/// The same in a child process: a crash, a hang or too much memory breaks the clause.
ConformanceVerdict isolated_conformance_of(const EstimatorEntry& estimator,
                                           const std::string& clause, const ProcessLimits& limits);

}  // namespace fathom

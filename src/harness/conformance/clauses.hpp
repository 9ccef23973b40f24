#pragma once

#include <vector>

#include "fathom/harness/conformance.hpp"
#include "subject.hpp"

namespace fathom::conformance {

/// A clause and how it is held against an estimator: `check` throws Broken or NotApplicable.
struct Clause {
  ConformanceClause stated;
  void (*check)(Subject& subject);
};

/// What an estimate is of dead reckoning and of loops.
std::vector<Clause> estimate_clauses();
/// Numbers and options that are none.
std::vector<Clause> failure_clauses();
/// Loops written either way round, losses and gates.
std::vector<Clause> loop_clauses();
/// Covariances of poses and motions.
std::vector<Clause> covariance_clauses();
/// Absolute measurements and an uncertain start.
std::vector<Clause> absolute_clauses();
/// What absolute measurements make of an estimate with loops.
std::vector<Clause> world_clauses();
/// What is made of errors that registrations of one picture share.
std::vector<Clause> shared_clauses();
/// Where dead reckoning has a hole, and where the start is free.
std::vector<Clause> hole_clauses();

}  // namespace fathom::conformance

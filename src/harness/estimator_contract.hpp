#pragma once

#include <cstddef>
#include <stdexcept>
#include <vector>

#include <Eigen/Core>

#include "fathom/estimation/estimator.hpp"

namespace fathom {

/// How an estimator broke its contract; the text stands behind the name of the call.
struct ContractViolation : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// Each throws ContractViolation.

void require_count(std::size_t count, std::size_t expected, const char* of_what);

/// The others are outcomes of a process.
void require_outcome(Outcome outcome);

/// One decision for each measurement, in their order, with a NIS that may be one: a NIS that is not
/// finite is none, as an innovation may be beyond what doubles carry.
void require_decisions(const UpdateReport& report, const Measurements& measurements);

/// Between 0 and 1, but for rounding: more is no part of a measurement.
void require_weights(const std::vector<double>& weights);

/// What makes a matrix no covariance, "is not finite"; null of one that may be. Whether it is
/// positive definite is a matter of its judgement: rounding may take that away.
const char* flaw_of(const Eigen::Ref<const Eigen::MatrixXd>& covariance);

}  // namespace fathom

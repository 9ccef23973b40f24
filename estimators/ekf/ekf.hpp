#pragma once

#include "estimators/support/filter/delayed_state.hpp"

namespace fathom {

/// Errors that pictures share are considered: with n as states, registrations are so precise that
/// one linearisation of them is not honest (docs/estimators/ekf.md).
struct EkfOptions : filter::DelayedStateOptions {
  EkfOptions() { shared_errors.model = SharedErrorModel::consider; }
};

/// The plain delayed-state EKF: errors of (x, y, θ) in world axes, Jacobians at the present
/// estimate. docs/estimators/ekf.md.
class Ekf final : public filter::DelayedStateFilter {
 public:
  using DelayedStateFilter::DelayedStateFilter;
};

EstimatorEntry ekf_entry();

}  // namespace fathom

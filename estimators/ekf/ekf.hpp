#pragma once

#include "estimators/support/filter/delayed_state.hpp"

namespace fathom {

using EkfOptions = filter::DelayedStateOptions;

/// The plain delayed-state EKF: errors of (x, y, θ) in world axes, Jacobians at the present
/// estimate. docs/estimators/ekf.md.
class Ekf final : public filter::DelayedStateFilter {
 public:
  using DelayedStateFilter::DelayedStateFilter;
};

EstimatorEntry ekf_entry();

}  // namespace fathom

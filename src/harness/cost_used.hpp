#pragma once

#include "fathom/harness/replay.hpp"

namespace fathom {

/// Σ ρ(eᵀ Ω e) over the absolute measurements that an estimator used, and of an uncertain start. Of
/// `result` the trajectory and the decisions must be there.
double absolute_cost_used(const MeasurementLog& log, const Estimate& estimate, const Run& result);

/// The same over all that it used; `absolute_cost_used` of the result must be there.
double cost_used(const MeasurementLog& log, const Estimate& estimate, const Run& result);

}  // namespace fathom

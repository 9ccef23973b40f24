#pragma once

#include "fathom/estimation/registry.hpp"

namespace fathom {

/// GTSAM's solvers of whole graphs: Levenberg-Marquardt, Gauss-Newton, dogleg.
EstimatorEntry gtsam_entry();

/// ISAM2 (Kaess et al. 2012).
EstimatorEntry gtsam_isam2_entry();

}  // namespace fathom

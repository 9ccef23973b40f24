#pragma once

#include <Eigen/Core>

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"

namespace fathom {

/// z − h and H of the stacked registrations at one iterate, and S = H P Hᵀ + R.
struct TrajectoryIekf::Linearisation {
  Eigen::VectorXd nu;  ///< z − h(x), headings wrapped
  StackedJacobian H;   ///< over the stretch only; zero elsewhere
  Eigen::MatrixXd S;
};

}  // namespace fathom

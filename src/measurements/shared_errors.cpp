#include "fathom/measurements/shared_errors.hpp"

#include "fathom/geometry/covariance.hpp"

namespace fathom {

Eigen::Matrix3d SharedErrors::total() const {
  const Eigen::Matrix3d by_from = from.scaled();
  const Eigen::Matrix3d by_to = to.scaled();
  return by_from * by_from.transpose() + by_to * by_to.transpose() + own;
}

SharedErrors SharedErrors::reversed(const Eigen::Matrix3d& J) const {
  return {{J * to.G, to.sigma}, {J * from.G, from.sigma}, transport(J, own)};
}

SharedErrors compose(const Pose& A, const SharedErrors& of_A, const Pose& B,
                     const SharedErrors& of_B) {
  Eigen::Matrix3d J_A;
  Eigen::Matrix3d J_B;
  compose(A, B, &J_A, &J_B);
  const Eigen::Matrix3d between = J_A * of_A.to.scaled() + J_B * of_B.from.scaled();
  return {{J_A * of_A.from.G, of_A.from.sigma},
          {J_B * of_B.to.G, of_B.to.sigma},
          transport(J_A, of_A.own) + transport(J_B, of_B.own) + between * between.transpose()};
}

}  // namespace fathom

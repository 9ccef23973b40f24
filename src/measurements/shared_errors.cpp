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

}  // namespace fathom

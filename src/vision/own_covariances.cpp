#include "fathom/vision/own_covariances.hpp"

#include <cmath>
#include <cstddef>

namespace fathom {

Eigen::Matrix3d OwnCovariances::beside(const PictureErrors& from, const PictureErrors& to) const {
  const auto is_told = [&](int error) { return from.sigma[error] > 0.0 || to.sigma[error] > 0.0; };
  const std::size_t told = (is_told(0) ? 1U : 0U) + (is_told(1) ? 2U : 0U);
  if (!is_told(1)) return by_told[told];
  return by_told[told] + std::pow(from.sigma[1], 4) * bend_from +
         std::pow(to.sigma[1], 4) * bend_to;
}

void OwnCovariances::scale(double factor) {
  for (Eigen::Matrix3d& own : by_told) own *= factor;
  bend_from *= factor;
  bend_to *= factor;
}

}  // namespace fathom

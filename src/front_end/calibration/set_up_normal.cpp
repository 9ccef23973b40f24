#include "set_up_normal.hpp"

#include <algorithm>
#include <cmath>

namespace fathom {

SetUpNormal normal_of(const std::vector<Beside>& beside, const SetUpParameters& p,
                      const ResidualSpread& spread) {
  SetUpNormal normal;
  const Eigen::Vector3d of_residual =
      Eigen::Vector3d(spread.sigma_m, spread.sigma_m, spread.sigma_rad).cwiseInverse();
  double of_noise = 0.0;
  for (const Beside& one : beside) {
    const Eigen::Vector2d seen = turned(one, p);
    Eigen::Matrix<double, 3, 5> J = Eigen::Matrix<double, 3, 5>::Zero();
    J.topLeftCorner<2, 1>() = -seen;
    J.block<2, 1>(0, 1) << seen.y(), -seen.x();
    J.block<2, 2>(0, 2) = -arm_of(one);
    J.col(4) = shifted(one, p);
    J = of_residual.asDiagonal() * J / one.noise;
    const Eigen::Vector3d residual = residual_of(one, p);
    const double weight = spread.weight(residual);
    const double curvature = spread.curvature(residual);
    // The score of the scale has a mean of so much at the true one, as the weights follow the same
    // errors (Stein 1981).
    const double noise_m = std::exp(p.log_scale) * of_residual.x() / one.noise;
    const double mean = curvature * noise_m * noise_m * one.seen_variance;
    Vector5 score = weight * J.transpose() * of_residual.cwiseProduct(residual);
    score(0) -= mean;
    of_noise += mean;
    normal.H += weight * J.transpose() * J;
    normal.curvature += curvature * J.transpose() * J;
    normal.scores += score * score.transpose();
    normal.g += score;
  }
  // Where most of the squares would be noise, what is left of them tells nothing.
  constexpr double kMost = 0.5;
  const double taken = std::min(of_noise, kMost * normal.curvature(0, 0));
  normal.g(0) += of_noise - taken;
  for (int i = 0; i < 2; ++i) {
    normal.H(i, i) -= taken;
    normal.curvature(i, i) -= taken;
  }
  if (of_noise > 0.0) normal.noise_bias = of_noise / normal.curvature(0, 0);
  return normal;
}

}  // namespace fathom

#pragma once

#include <vector>

#include "residuals.hpp"
#include "set_up_fit.hpp"

namespace fathom {

/// What least squares and the covariance of its estimate take of the motions.
struct SetUpNormal {
  Matrix5 H = Matrix5::Zero();          ///< of the weighted squares
  Matrix5 curvature = Matrix5::Zero();  ///< of the density
  Matrix5 scores = Matrix5::Zero();     ///< Σ g gᵀ
  Vector5 g = Vector5::Zero();
  /// By what the noise of the registered translations, as they tell it, would make the logarithm of
  /// the scale smaller if it were not taken out; above 1 it is not taken out as a whole.
  double noise_bias = 0.0;
};

/// With the residuals' weights in Student's t. Registered translations are regressors with errors
/// of a known covariance C: their squares are larger by tr C than those of the true ones, which is
/// taken out.
SetUpNormal normal_of(const std::vector<Beside>& beside, const SetUpParameters& p,
                      const ResidualSpread& spread);

}  // namespace fathom

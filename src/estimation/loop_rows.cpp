#include "fathom/estimation/loop_rows.hpp"

#include <Eigen/Cholesky>

#include "fathom/geometry/covariance.hpp"

namespace fathom {

// ν = −D e, D = diag(Rot(θ_z), 1): what Ω's rows measure of e, −rows Dᵀ measures of ν; the sign of
// a row is free.
LoopRows loop_rows(const RelativePose& forward) {
  if (is_positive_definite(forward.information)) {
    return {Eigen::Matrix3d::Identity(), forward.covariance(), 3};
  }
  const InformationRows measured = rows_of(forward.information);
  const Eigen::Matrix3d D = planar_rotation(forward.motion.theta);
  return {measured.rows * D.transpose(), measured.variances.asDiagonal(), measured.rank};
}

Eigen::Matrix3d whitening(const Eigen::Matrix3d& information) {
  if (is_positive_definite(information)) return information.llt().matrixU();
  const InformationRows measured = rows_of(information);
  return measured.variances.cwiseSqrt().cwiseInverse().asDiagonal() * measured.rows;
}

}  // namespace fathom

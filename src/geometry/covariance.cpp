#include "fathom/geometry/covariance.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace fathom {
namespace {

Eigen::Matrix3d symmetrised(const Eigen::Matrix3d& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

// D M D with D = diag(M)^(-1/2): unit diagonal, no units left.
Eigen::Vector3d unit_diagonal_scale(const Eigen::Matrix3d& matrix) {
  return matrix.diagonal().cwiseSqrt().cwiseInverse();
}

}  // namespace

Eigen::Matrix3d transport(const Eigen::Matrix3d& J, const Eigen::Matrix3d& covariance) {
  return symmetrised(J * covariance * J.transpose());
}

UncertainPose compose(const UncertainPose& X, const UncertainPose& Y) {
  Eigen::Matrix3d J_X;
  Eigen::Matrix3d J_Y;
  const Pose mean = compose(X.mean, Y.mean, &J_X, &J_Y);
  return {mean, transport(J_X, X.covariance) + transport(J_Y, Y.covariance)};
}

UncertainPose inverse(const UncertainPose& X) {
  Eigen::Matrix3d J;
  const Pose mean = inverse(X.mean, &J);
  return {mean, transport(J, X.covariance)};
}

UncertainPose between(const UncertainPose& A, const UncertainPose& B) {
  Eigen::Matrix3d J_A;
  Eigen::Matrix3d J_B;
  const Pose mean = between(A.mean, B.mean, &J_A, &J_B);
  return {mean, transport(J_A, A.covariance) + transport(J_B, B.covariance)};
}

UncertainPose between(const Pose& A, const Pose& B, const PairCovariance& covariance) {
  Eigen::Matrix3d H_A;
  Eigen::Matrix3d H_B;
  const Pose mean = between(A, B, &H_A, &H_B);
  const Eigen::Matrix3d cross = H_A * covariance.cross * H_B.transpose();
  Eigen::Matrix3d C = transport(H_B, covariance.B);
  C += transport(H_A, covariance.A) + cross + cross.transpose();
  return {mean, C};
}

UncertainPose compose_chain(std::span<const UncertainPose> motions) {
  UncertainPose chain;
  for (const UncertainPose& motion : motions) chain = compose(chain, motion);
  return chain;
}

bool is_positive_definite(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || (matrix.diagonal().array() <= 0.0).any()) return false;
  const Eigen::Vector3d scale = unit_diagonal_scale(matrix);
  const Eigen::Matrix3d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled, Eigen::EigenvaluesOnly);
  // Below this the inverse has no digit left that means anything.
  constexpr double kSmallest = 1e-12;
  return solver.info() == Eigen::Success && solver.eigenvalues().minCoeff() > kSmallest;
}

Eigen::Matrix3d symmetric_inverse(const Eigen::Matrix3d& matrix) {
  const Eigen::Vector3d scale = unit_diagonal_scale(matrix);
  const Eigen::Matrix3d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::Matrix3d inverted = scaled.llt().solve(Eigen::Matrix3d::Identity());
  return symmetrised(scale.asDiagonal() * inverted * scale.asDiagonal());
}

}  // namespace fathom

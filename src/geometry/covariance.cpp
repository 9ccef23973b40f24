#include "fathom/geometry/covariance.hpp"

#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>

namespace fathom {
namespace {

// Of a matrix with a unit diagonal: below this an eigenvalue has no digit left that means anything.
constexpr double kSmallest = 1e-12;

Eigen::Matrix3d symmetrised(const Eigen::Matrix3d& matrix) {
  return 0.5 * (matrix + matrix.transpose());
}

// D M D with D = diag(M)^(-1/2): unit diagonal, no units left.
Eigen::Vector3d unit_diagonal_scale(const Eigen::Matrix3d& matrix) {
  return matrix.diagonal().cwiseSqrt().cwiseInverse();
}

// Without eigenvalues: with unit diagonal the two larger ones multiply to 9/4 at most, so the least
// is 4/9 of the determinant at least.
bool is_plainly_definite(const Eigen::Matrix3d& matrix) {
  const double a = matrix(0, 0);
  const double b = matrix(1, 1);
  const double c = matrix(2, 2);
  const double xy = matrix(0, 1);
  const double xt = matrix(0, 2);
  const double yt = matrix(1, 2);
  const double minor = a * b - xy * xy;
  const double determinant = minor * c - a * yt * yt + xy * xt * yt * 2.0 - b * xt * xt;
  constexpr double kPlain = 1e-9;
  return minor > kPlain * a * b && determinant > kPlain * a * b * c;
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

UncertainPose part_of(const UncertainPose& motion, double from_share, double to_share) {
  if (from_share == 0.0 && to_share == 1.0) return motion;
  const auto after = [&motion](double share) {
    return Pose{motion.mean.x * share, motion.mean.y * share, motion.mean.theta * share};
  };
  const Pose start = after(from_share);
  // The covariance is in the axes of the motion's start; the part's is in those of its own.
  return {between(start, after(to_share)),
          transport(planar_rotation(-start.theta), (to_share - from_share) * motion.covariance)};
}

UncertainPose compose_chain(std::span<const UncertainPose> motions) {
  UncertainPose chain;
  for (const UncertainPose& motion : motions) chain = compose(chain, motion);
  return chain;
}

bool is_positive_definite(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || (matrix.diagonal().array() <= 0.0).any()) return false;
  if (is_plainly_definite(matrix)) return true;
  const Eigen::Vector3d scale = unit_diagonal_scale(matrix);
  const Eigen::Matrix3d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled, Eigen::EigenvaluesOnly);
  return solver.info() == Eigen::Success && solver.eigenvalues().minCoeff() > kSmallest;
}

bool is_positive_semidefinite(const Eigen::Matrix3d& matrix) {
  if (!matrix.allFinite() || (matrix.diagonal().array() < 0.0).any()) return false;
  Eigen::Matrix3d scaled;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      if (matrix(i, i) > 0.0 && matrix(j, j) > 0.0) {
        scaled(i, j) = matrix(i, j) / std::sqrt(matrix(i, i)) / std::sqrt(matrix(j, j));
      } else if (matrix(i, j) != 0.0) {
        return false;
      } else {
        scaled(i, j) = 0.0;
      }
    }
  }
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled, Eigen::EigenvaluesOnly);
  return solver.info() == Eigen::Success && solver.eigenvalues().minCoeff() >= -kSmallest;
}

// Ω = S U Λ Uᵀ S with a unit diagonal between both S, so that no unit decides what counts as zero.
InformationRows rows_of(const Eigen::Matrix3d& information) {
  const Eigen::Vector3d S = information.diagonal().cwiseMax(0.0).cwiseSqrt();
  Eigen::Vector3d S_inverse;
  for (int i = 0; i < 3; ++i) S_inverse(i) = S(i) > 0.0 ? 1.0 / S(i) : 0.0;
  const Eigen::Matrix3d scaled =
      symmetrised(S_inverse.asDiagonal() * information * S_inverse.asDiagonal());
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(scaled);
  InformationRows result;
  for (int i = 2; i >= 0; --i) {
    const double value = solver.eigenvalues()(i);
    if (!(value > kSmallest)) break;
    result.rows.row(result.rank) = solver.eigenvectors().col(i).transpose() * S.asDiagonal();
    result.variances(result.rank++) = 1.0 / value;
  }
  return result;
}

int rank_of(const Eigen::Matrix3d& information) {
  return is_positive_definite(information) ? 3 : rows_of(information).rank;
}

Eigen::Matrix3d symmetric_inverse(const Eigen::Matrix3d& matrix) {
  const Eigen::Vector3d scale = unit_diagonal_scale(matrix);
  const Eigen::Matrix3d scaled = scale.asDiagonal() * matrix * scale.asDiagonal();
  const Eigen::Matrix3d inverted = scaled.llt().solve(Eigen::Matrix3d::Identity());
  return symmetrised(scale.asDiagonal() * inverted * scale.asDiagonal());
}

}  // namespace fathom

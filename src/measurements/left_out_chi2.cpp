#include <cmath>
#include <cstddef>
#include <limits>
#include <vector>

#include <Eigen/Eigenvalues>

#include "restricted_likelihood.hpp"

namespace fathom {
namespace {

// ρᵀ Q⁻¹ ρ over the directions that Q has.
double pseudo_chi2(const Eigen::Vector3d& rho, const Eigen::Matrix3d& Q) {
  constexpr double kSmallest = 1e-10;
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(Q);
  double sum = 0.0;
  for (int i = 0; i < 3; ++i) {
    const double along = solver.eigenvectors().col(i).dot(rho);
    if (solver.eigenvalues()[i] > kSmallest) sum += along * along / solver.eigenvalues()[i];
  }
  return sum;
}

}  // namespace

// A registration's residual ρ = √w (c_r + B_r y) has the covariance Q = I − w B_r S H⁻¹ S B_rᵀ;
// predicted by all others it is Q⁻¹ ρ, of covariance Q⁻¹. Where the others say nothing Q and ρ are
// zero.
std::vector<double> RestrictedLikelihood::left_out_chi2(const Eigen::VectorXd& log_sigma) {
  std::vector<double> chi2(rows_.registrations().size(), std::numeric_limits<double>::quiet_NaN());
  if (!std::isfinite(deviance(log_sigma))) return chi2;
  const Eigen::SparseMatrix<double, Eigen::RowMajor> B = rows_.B();
  for (std::size_t i = 0; i < chi2.size(); ++i) {
    const Index first = rows_.registrations()[i];
    if (first < 0) continue;
    const double root_w = is_own_row_[first] > 0.0 ? std::sqrt(own_weight_) : 1.0;
    const Index count = B.outerIndexPtr()[first + 1] - B.outerIndexPtr()[first];
    const auto* const columns = B.innerIndexPtr() + B.outerIndexPtr()[first];
    Eigen::MatrixXd J(3, count);
    Eigen::MatrixXd Z(count, count);
    for (Index a = 0; a < count; a += 3) {
      for (Index b = 0; b < count; b += 3) {
        Z.block<3, 3>(a, b) = factor_.inverse(columns[a] / 3, columns[b] / 3);
      }
    }
    for (Index a = 0; a < count; ++a) {
      for (Index row = 0; row < 3; ++row) {
        J(row, a) = root_w * scale_[columns[a]] * B.valuePtr()[B.outerIndexPtr()[first + row] + a];
      }
    }
    const Eigen::Matrix3d Q = Eigen::Matrix3d::Identity() - J * Z * J.transpose();
    chi2[i] = pseudo_chi2(root_w * residuals_.segment<3>(first), Q);
  }
  return chi2;
}

}  // namespace fathom

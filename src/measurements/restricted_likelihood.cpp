#include "restricted_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Eigenvalues>

namespace fathom {
namespace {

// Of a pivot, as a part of its diagonal element: below it holds rounding alone.
constexpr double kSmallestPivot = 64.0 * std::numeric_limits<double>::epsilon();

// NaN, as told, is the same as NaN.
bool are_same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) return false;
  for (Eigen::Index j = 0; j < a.size(); ++j) {
    if (a[j] != b[j] && !(std::isnan(a[j]) && std::isnan(b[j]))) return false;
  }
  return true;
}

bool has_own(std::span<const VarianceComponent> components) {
  return std::ranges::any_of(components,
                             [](const VarianceComponent& one) { return !one.is_of_pictures(); });
}

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

RestrictedLikelihood::RestrictedLikelihood(const MeasurementLog& log,
                                           std::span<const Pose> trajectory,
                                           std::span<const VarianceComponent> components,
                                           const std::vector<bool>& used)
    : rows_(log, trajectory, used, has_own(components)),
      told_scale_(Eigen::VectorXd::Ones(rows_.unknowns())) {
  for (const Index row : rows_.own()) told_scale_.segment<3>(row).setZero();
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (const auto row = rows_.picture(k)) told_scale_.segment<3>(*row) = rows_.told_sigma(k);
  }
  const Eigen::SparseMatrix<double> square = rows_.B().transpose() * rows_.B();
  A_ = square.triangularView<Eigen::Lower>();
  gradient_ = rows_.B().transpose() * rows_.c();
  H_ = A_;
  factor_.analyzePattern(H_);
  for (const VarianceComponent& component : components) govern(component, log.size());
}

void RestrictedLikelihood::govern(const VarianceComponent& component, std::size_t keyframes) {
  const bool is_tilt = component.part == VarianceComponent::Part::tilt;
  std::vector<Governed>& governed = governed_.emplace_back();
  if (!component.is_of_pictures()) {
    for (const Index first : rows_.own()) {
      for (Index part = 0; part < 3; ++part) governed.push_back({first + part, 0.0});
    }
    return;
  }
  for (std::size_t k = 0; k < keyframes; ++k) {
    const auto first = rows_.picture(k);
    if (!first || !(component.governed.empty() || component.governed[k])) continue;
    for (int part = is_tilt ? 1 : 0; part < (is_tilt ? 3 : 1); ++part) {
      governed.push_back({*first + part, rows_.told_sigma(k)[part]});
    }
  }
}

std::size_t RestrictedLikelihood::pictures(Index component) const {
  std::vector<Index> pictures;
  for (const Governed& n : governed_[static_cast<std::size_t>(component)]) {
    if (A_.coeff(n.row, n.row) > 0.0) pictures.push_back((n.row - rows_.poses()) / 3);
  }
  return static_cast<std::size_t>(
      std::distance(pictures.begin(), std::unique(pictures.begin(), pictures.end())));
}

double RestrictedLikelihood::negligible(Index component) const {
  double most = 0.0;
  for (const Governed& n : governed_[static_cast<std::size_t>(component)]) {
    most = std::max(most, A_.coeff(n.row, n.row));
  }
  return 1e-3 / std::sqrt(most);
}

double RestrictedLikelihood::told(Index component) const {
  std::vector<double> told;
  for (const Governed& n : governed_[static_cast<std::size_t>(component)]) told.push_back(n.told);
  if (told.empty()) return 0.0;
  const auto middle = told.begin() + static_cast<std::ptrdiff_t>(told.size() / 2);
  std::nth_element(told.begin(), middle, told.end());
  return *middle;
}

double RestrictedLikelihood::degrees_of_freedom() const {
  return static_cast<double>(rows_.c().size() - rows_.poses());
}

// H = S Bᵀ B S + I on the rows of n, for n in units of σ: regular at σ = 0.
bool RestrictedLikelihood::factorise(const Eigen::VectorXd& log_sigma) {
  scale_ = told_scale_;
  for (Index j = 0; j < components(); ++j) {
    if (std::isnan(log_sigma[j])) continue;  // as told
    const double sigma = std::exp(log_sigma[j]);
    for (const Governed& n : governed_[static_cast<std::size_t>(j)]) {
      scale_[n.row] = sigma;
    }
  }
  for (Index column = 0; column < H_.cols(); ++column) {
    const Index end = H_.outerIndexPtr()[column + 1];
    for (Index e = H_.outerIndexPtr()[column]; e < end; ++e) {
      const Index row = H_.innerIndexPtr()[e];
      const double prior = row == column && row >= rows_.poses() ? 1.0 : 0.0;
      H_.valuePtr()[e] = scale_[row] * A_.valuePtr()[e] * scale_[column] + prior;
    }
  }
  factor_.factorize(H_);
  if (factor_.info() != Eigen::Success) return false;
  const Eigen::VectorXd diagonal = factor_.permutationP() * Eigen::VectorXd(H_.diagonal());
  return (factor_.vectorD().array() > kSmallestPivot * diagonal.array()).all();
}

// From the residuals, not from their squares at y = 0, which may be 10¹⁰ times as large.
void RestrictedLikelihood::minimise() {
  v_ = -factor_.solve(scale_.cwiseProduct(gradient_));
  const Eigen::VectorXd residuals = rows_.c() + rows_.B() * scale_.cwiseProduct(v_);
  chi2_ = residuals.squaredNorm() + v_.tail(rows_.unknowns() - rows_.poses()).squaredNorm();
}

double RestrictedLikelihood::deviance(const Eigen::VectorXd& log_sigma) {
  if (are_same(log_sigma, at_)) return deviance_;
  at_ = log_sigma;
  deviance_ = std::numeric_limits<double>::quiet_NaN();
  if (!factorise(log_sigma)) return deviance_;
  minimise();
  deviance_ = chi2_ + factor_.vectorD().array().log().sum() + rows_.log_own();
  return deviance_;
}

RestrictedFit RestrictedLikelihood::fit(const Eigen::VectorXd& log_sigma) {
  RestrictedFit fit;
  fit.deviance = deviance(log_sigma);
  if (!std::isfinite(fit.deviance)) return fit;
  fit.y = scale_.cwiseProduct(v_);
  fit.chi2 = chi2_;
  add_derivatives(log_sigma, fit);
  return fit;
}

// With u_j the part of v that component j governs:
//   ∂(−2ℓ)/∂log σ_j = 2 (number − Σ (H⁻¹)_rr − ‖u_j‖²)
//   average information of j, k = 4 u_jᵀ · (H⁻¹ S A n_k)_j,  n_k = S u_k.
void RestrictedLikelihood::add_derivatives(const Eigen::VectorXd& log_sigma, RestrictedFit& fit) {
  const SparseInverse inverse(factor_);
  fit.slope = Eigen::VectorXd::Zero(components());
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(rows_.unknowns(), components());
  for (Index j = 0; j < components(); ++j) {
    if (std::isnan(log_sigma[j])) continue;
    for (const Governed& n : governed_[static_cast<std::size_t>(j)]) {
      u(n.row, j) = v_[n.row];
      fit.slope[j] += 2.0 * (1.0 - inverse(n.row, n.row) - v_[n.row] * v_[n.row]);
    }
  }
  const Eigen::MatrixXd moved = A_.selfadjointView<Eigen::Lower>() * (scale_.asDiagonal() * u);
  const Eigen::MatrixXd answer = factor_.solve(scale_.asDiagonal() * moved);
  fit.information = 4.0 * u.transpose() * answer;
}

// A registration's residual ρ = c_r + B_r y has the covariance Q = I − B_r S H⁻¹ S B_rᵀ; predicted
// by all others it is Q⁻¹ ρ, of covariance Q⁻¹. Where the others say nothing Q and ρ are zero.
std::vector<double> RestrictedLikelihood::left_out_chi2(const Eigen::VectorXd& log_sigma) {
  std::vector<double> chi2(rows_.registrations().size(), std::numeric_limits<double>::quiet_NaN());
  if (!std::isfinite(deviance(log_sigma))) return chi2;
  const SparseInverse inverse(factor_);
  const Eigen::SparseMatrix<double, Eigen::RowMajor> B = rows_.B();
  const Eigen::VectorXd residuals = rows_.c() + B * scale_.cwiseProduct(v_);
  for (std::size_t i = 0; i < chi2.size(); ++i) {
    const Index first = rows_.registrations()[i];
    if (first < 0) continue;
    const Index count = B.outerIndexPtr()[first + 1] - B.outerIndexPtr()[first];
    const auto* const columns = B.innerIndexPtr() + B.outerIndexPtr()[first];
    Eigen::MatrixXd J(3, count);
    Eigen::MatrixXd Z(count, count);
    for (Index a = 0; a < count; ++a) {
      for (Index b = 0; b < count; ++b) Z(a, b) = inverse(columns[a], columns[b]);
      for (Index row = 0; row < 3; ++row) {
        J(row, a) = scale_[columns[a]] * B.valuePtr()[B.outerIndexPtr()[first + row] + a];
      }
    }
    const Eigen::Matrix3d Q = Eigen::Matrix3d::Identity() - J * Z * J.transpose();
    chi2[i] = pseudo_chi2(residuals.segment<3>(first), Q);
  }
  return chi2;
}

}  // namespace fathom

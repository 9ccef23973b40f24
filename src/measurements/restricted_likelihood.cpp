#include "restricted_likelihood.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom {
namespace {

// NaN, as told, is the same as NaN.
bool are_same(const Eigen::VectorXd& a, const Eigen::VectorXd& b) {
  if (a.size() != b.size()) return false;
  for (Eigen::Index j = 0; j < a.size(); ++j) {
    if (a[j] != b[j] && !(std::isnan(a[j]) && std::isnan(b[j]))) return false;
  }
  return true;
}

Eigen::VectorXd own_rows(const JointRows& rows, std::span<const VarianceComponent> components) {
  Eigen::VectorXd own = Eigen::VectorXd::Zero(rows.c().size());
  const auto is_of_pictures = [](const VarianceComponent& one) { return one.is_of_pictures(); };
  if (std::ranges::all_of(components, is_of_pictures)) return own;
  for (const Eigen::Index first : rows.told()) own.segment<3>(first).setOnes();
  return own;
}

}  // namespace

RestrictedLikelihood::RestrictedLikelihood(const MeasurementLog& log,
                                           std::span<const Pose> trajectory,
                                           std::span<const VarianceComponent> components,
                                           const std::vector<bool>& used)
    : rows_(log, trajectory, used),
      is_own_row_(own_rows(rows_, components)),
      told_scale_(Eigen::VectorXd::Ones(rows_.unknowns())),
      factor_(rows_.B(), is_own_row_) {
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (const auto row = rows_.picture(k)) told_scale_.segment<3>(*row) = rows_.told_sigma(k);
  }
  for (const VarianceComponent& component : components) govern(component, log.size());
  const Eigen::VectorXd is_rest = 1.0 - is_own_row_.array();
  diagonal_ = rows_.B().cwiseAbs2().transpose() * Eigen::VectorXd::Ones(rows_.c().size());
  gradient_ = {rows_.B().transpose() * is_rest.cwiseProduct(rows_.c()),
               rows_.B().transpose() * is_own_row_.cwiseProduct(rows_.c())};
}

void RestrictedLikelihood::govern(const VarianceComponent& component, std::size_t keyframes) {
  const bool is_tilt = component.part == VarianceComponent::Part::tilt;
  std::vector<Governed>& governed = governed_.emplace_back();
  if (!component.is_of_pictures()) {
    own_ = components() - 1;
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
  if (component == own_) return rows_.told().size();
  std::vector<Index> pictures;
  for (const Governed& n : governed_[static_cast<std::size_t>(component)]) {
    if (diagonal_[n.row] > 0.0) pictures.push_back((n.row - rows_.poses()) / 3);
  }
  return static_cast<std::size_t>(
      std::distance(pictures.begin(), std::unique(pictures.begin(), pictures.end())));
}

double RestrictedLikelihood::negligible(Index component) const {
  double most = component == own_ && !rows_.told().empty() ? 1.0 : 0.0;
  for (const Governed& n : governed_[static_cast<std::size_t>(component)]) {
    most = std::max(most, diagonal_[n.row]);
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

void RestrictedLikelihood::set_scales(const Eigen::VectorXd& log_sigma) {
  scale_ = told_scale_;
  own_sigma_ = 0.0;
  for (Index j = 0; j < components(); ++j) {
    if (std::isnan(log_sigma[j])) continue;  // as told
    const double sigma = std::exp(log_sigma[j]);
    if (j == own_) own_sigma_ = sigma;
    for (const Governed& n : governed_[static_cast<std::size_t>(j)]) scale_[n.row] = sigma;
  }
  own_weight_ = 1.0 / (1.0 + own_sigma_ * own_sigma_);
  weights_ =
      (is_own_row_.array() > 0.0).select(own_weight_, Eigen::VectorXd::Ones(is_own_row_.size()));
}

// In units of σ, that is, with a prior of 1 on the rows of n: regular at σ = 0.
bool RestrictedLikelihood::factorise(const Eigen::VectorXd& log_sigma) {
  set_scales(log_sigma);
  return factor_.factorise(scale_, own_weight_, rows_.poses());
}

// From the residuals, not from their squares at y = 0, which may be 10¹⁰ times as large.
void RestrictedLikelihood::minimise() {
  v_ = -factor_.solve(scale_.cwiseProduct(gradient_.rest + own_weight_ * gradient_.own));
  residuals_ = rows_.c() + rows_.B() * scale_.cwiseProduct(v_);
  chi2_ = weights_.dot(residuals_.cwiseAbs2()) +
          v_.tail(rows_.unknowns() - rows_.poses()).squaredNorm();
}

double RestrictedLikelihood::deviance(const Eigen::VectorXd& log_sigma) {
  if (are_same(log_sigma, at_)) return deviance_;
  at_ = log_sigma;
  deviance_ = std::numeric_limits<double>::quiet_NaN();
  if (!factorise(log_sigma)) return deviance_;
  minimise();
  deviance_ =
      chi2_ + factor_.log_determinant() - own_count() * std::log(own_weight_) + rows_.log_own();
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
//   average information of j, k = 4 u_jᵀ · (H⁻¹ S Bᵀ W B n_k)_j,  n_k = S u_k.
// Own errors are n, too, of one row each: u = −σ w r, with the variance w + σ² w² b H⁻¹ bᵀ.
void RestrictedLikelihood::add_derivatives(const Eigen::VectorXd& log_sigma, RestrictedFit& fit) {
  fit.slope = Eigen::VectorXd::Zero(components());
  Eigen::MatrixXd u = Eigen::MatrixXd::Zero(rows_.unknowns(), components());
  for (Index j = 0; j < components(); ++j) {
    if (std::isnan(log_sigma[j])) continue;
    for (const Governed& n : governed_[static_cast<std::size_t>(j)]) {
      u(n.row, j) = v_[n.row];
      fit.slope[j] += 2.0 * (1.0 - factor_.variance(n.row) - v_[n.row] * v_[n.row]);
    }
  }
  Eigen::MatrixXd p = rows_.B() * (scale_.asDiagonal() * u);  // what n_k does to the rows
  Eigen::VectorXd own_u = Eigen::VectorXd::Zero(p.rows());
  if (own_ >= 0) {
    const double share = own_sigma_ * own_sigma_ * own_weight_;
    fit.slope[own_] =
        2.0 * share * (own_count() - own_weight_ * (factor_.own_trace() + own_squared_norm()));
    own_u = -own_sigma_ * own_weight_ * is_own_row_.cwiseProduct(residuals_);
    p.col(own_) = own_sigma_ * own_u;
  }
  const Eigen::MatrixXd answer =
      factor_.solve(scale_.asDiagonal() * (rows_.B().transpose() * (weights_.asDiagonal() * p)));
  fit.information = 4.0 * u.transpose() * answer;
  if (own_ >= 0) {
    const Eigen::MatrixXd left = p - rows_.B() * (scale_.asDiagonal() * answer);
    fit.information.row(own_) = 4.0 * own_sigma_ * own_weight_ * own_u.transpose() * left;
  }
}

}  // namespace fathom

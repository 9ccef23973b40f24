#include "motion_covariance.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>

#include <Eigen/Dense>

#include "point_shifts.hpp"

namespace fathom {
namespace {

constexpr double kLeastPivot = 1e-9;  // of the largest

// Of altitude, roll and pitch.
Eigen::Vector3d sigmas_of(const Viewpoint& view, const CovarianceOptions& options) {
  const double tilt_rad = view.tilt_sigma_rad.value_or(options.tilt());
  return {std::max(options.altitude(), view.altitude_sigma_m), tilt_rad, tilt_rad};
}

}  // namespace

Eigen::Matrix3d shared_error(double rms_m, double share) {
  const double shared_m = share * rms_m / std::numbers::sqrt2;
  return Eigen::Vector3d(shared_m * shared_m, shared_m * shared_m, 0.0).asDiagonal();
}

LinearFit::LinearFit(const Pose& z, std::span<const Eigen::Vector2d> p,
                     std::span<const Eigen::Vector2d> q, std::span<const double> weights)
    : z_(z), p_(p), q_(q), weights_(weights) {
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
  residuals_.reserve(p_.size());
  for (std::size_t j = 0; j < p_.size(); ++j) {
    const Eigen::Matrix<double, 2, 3> J = jacobian(j);
    A += weights_[j] * J.transpose() * J;
    residuals_.emplace_back(p_[j] - transform(z_, q_[j]));
  }
  inverse_ = A.inverse();
}

Eigen::Matrix<double, 2, 3> LinearFit::jacobian(std::size_t j) const {
  const Eigen::Vector2d turned = rotation(z_.theta) * q_[j];
  Eigen::Matrix<double, 2, 3> J;
  J << 1.0, 0.0, -turned.y(), 0.0, 1.0, turned.x();
  return J;
}

double LinearFit::variance() const {
  double squares = 0.0;
  for (std::size_t j = 0; j < p_.size(); ++j) squares += weights_[j] * residuals_[j].squaredNorm();
  return squares / (2.0 * static_cast<double>(p_.size()) - unknowns_);
}

template <class Shift>
Eigen::Vector3d LinearFit::response(const Shift& shift) const {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t j = 0; j < p_.size(); ++j) {
    sum += weights_[j] * jacobian(j).transpose() * shift(j);
  }
  return inverse_ * sum;
}

Eigen::Matrix3d LinearFit::covariance() const {
  return variance() * inverse_;
}

double LinearFit::clustering(double cell_m, int least_cells) const {
  if (!(cell_m > 0.0)) return 1.0;
  std::map<std::pair<long, long>, Eigen::Vector3d> cells;
  for (std::size_t j = 0; j < p_.size(); ++j) {
    const std::pair cell{std::lround(q_[j].x() / cell_m), std::lround(q_[j].y() / cell_m)};
    const auto [entry, is_new] = cells.try_emplace(cell, Eigen::Vector3d::Zero());
    entry->second += weights_[j] * jacobian(j).transpose() * residuals_[j];
  }
  if (cells.size() < static_cast<std::size_t>(least_cells)) return 1.0;
  Eigen::Matrix3d scatter = Eigen::Matrix3d::Zero();
  for (const auto& [cell, score] : cells) scatter += score * score.transpose();
  const auto count = static_cast<double>(cells.size());
  // What is fitted takes `unknowns_` of the 2 · count directions that the cells' errors have.
  const Eigen::Matrix3d robust = inverse_ * scatter * inverse_ * (count / (count - unknowns_ / 2));
  const double ratio = (covariance().inverse() * robust).trace() / 3.0;
  return std::isfinite(ratio) ? std::max(1.0, ratio) : 1.0;
}

Eigen::MatrixXd LinearFit::whitened_columns(const Viewpoint& from, const Viewpoint& to,
                                            const CovarianceOptions& options) const {
  Eigen::MatrixXd B(2 * static_cast<Eigen::Index>(p_.size()), 9);
  Eigen::Index count = 0;
  const auto add = [&](const auto& column_of) {
    for (std::size_t j = 0; j < p_.size(); ++j) {
      B.col(count).segment<2>(2 * static_cast<Eigen::Index>(j)) =
          std::sqrt(weights_[j]) * column_of(j);
    }
    ++count;
  };
  for (int i = 0; i < 3; ++i) {
    add([&](std::size_t j) { return jacobian(j).col(i).eval(); });
  }
  // Points without a picture have no altitude, and no errors of one.
  if (!(from.altitude_m > 0.0) || !(to.altitude_m > 0.0)) return B.leftCols(count);
  const Eigen::Matrix2d R = rotation(z_.theta);
  const auto is_told = [&](const Viewpoint& view, int error) {
    return sigmas_of(view, options)[error] > 0.0;
  };
  for (int error = 0; error < 3; ++error) {
    // At z ⊕ q, not at p: by their difference the altitudes would explain any error of a match.
    if (is_told(from, error)) {
      add([&](std::size_t j) {
        return shift_by_errors(from, transform(z_, q_[j])).col(error).eval();
      });
    }
    if (is_told(to, error)) {
      add([&](std::size_t j) { return (R * shift_by_errors(to, q_[j]).col(error)).eval(); });
    }
  }
  return B.leftCols(count);
}

double LinearFit::take_out_altitude_and_tilt(const Viewpoint& from, const Viewpoint& to,
                                             const CovarianceOptions& options) {
  const Eigen::MatrixXd B = whitened_columns(from, to, options);
  if (B.cols() == 3 || B.rows() <= B.cols()) return 1.0;
  Eigen::VectorXd r(B.rows());
  for (std::size_t j = 0; j < p_.size(); ++j) {
    r.segment<2>(2 * static_cast<Eigen::Index>(j)) = std::sqrt(weights_[j]) * residuals_[j];
  }
  // Of two pictures from one place both columns of an error are one.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(B.rows(), B.cols());
  qr.setThreshold(kLeastPivot);
  qr.compute(B);
  r -= B * qr.solve(r);
  const double before = variance();
  unknowns_ = static_cast<double>(qr.rank());
  for (std::size_t j = 0; j < p_.size(); ++j) {
    residuals_[j] = r.segment<2>(2 * static_cast<Eigen::Index>(j)) / std::sqrt(weights_[j]);
  }
  return before > 0.0 ? std::sqrt(variance() / before) : 1.0;
}

SharedErrors LinearFit::altitude_and_tilt(const Viewpoint& from, const Viewpoint& to,
                                          const CovarianceOptions& options) const {
  SharedErrors shared;
  shared.from.sigma = sigmas_of(from, options);
  shared.to.sigma = sigmas_of(to, options);
  const Eigen::Matrix2d R = rotation(z_.theta);
  for (int error = 0; error < 3; ++error) {
    // Points without a picture have no altitude, and no errors of one.
    if (!(from.altitude_m > 0.0) || !(to.altitude_m > 0.0)) break;
    shared.from.G.col(error) =
        response([&](std::size_t j) { return shift_by_errors(from, p_[j]).col(error).eval(); });
    shared.to.G.col(error) = -response(
        [&](std::size_t j) { return (R * shift_by_errors(to, q_[j]).col(error)).eval(); });
  }
  return shared;
}

Eigen::Matrix3d total_of(const PictureErrors& from, const PictureErrors& to) {
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (int error = 0; error < 3; ++error) {
    const double sigma_from = from.sigma[error];
    const double sigma_to = to.sigma[error];
    if (sigma_from == 0.0 && sigma_to == 0.0) continue;
    const Eigen::Vector3d by_from = from.G.col(error);
    const Eigen::Vector3d by_to = to.G.col(error);
    // With both alike the sum comes first, as the last bit goes by it.
    if (sigma_from == sigma_to) {
      sum += sigma_to * sigma_to * (by_from * by_from.transpose() + by_to * by_to.transpose());
    } else {
      sum += sigma_from * sigma_from * by_from * by_from.transpose() +
             sigma_to * sigma_to * by_to * by_to.transpose();
    }
  }
  return sum;
}

}  // namespace fathom

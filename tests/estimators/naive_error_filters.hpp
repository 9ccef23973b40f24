#pragma once

#include <cmath>
#include <functional>
#include <unsupported/Eigen/MatrixFunctions>
#include <vector>

#include <Eigen/Dense>

#include "fathom/measurements/measurement_log.hpp"
#include "tests/estimators/naive_filters.hpp"

/// Textbook filters on absolute poses with another error, or with Jacobians at other places. H is
/// taken by differences, poses of the invariant filter are 3×3 matrices of SE(2).
namespace fathom::test {

inline Eigen::Matrix3d matrix_of(const Pose& X) {
  Eigen::Matrix3d T;
  T << std::cos(X.theta), -std::sin(X.theta), X.x, std::sin(X.theta), std::cos(X.theta), X.y, 0, 0,
      1;
  return T;
}

inline Pose pose_of(const Eigen::Matrix3d& T) {
  return {T(0, 2), T(1, 2), std::atan2(T(1, 0), T(0, 0))};
}

/// exp of the twist (ρ, φ) by the series of the matrix exponential.
inline Eigen::Matrix3d matrix_exponential(const Eigen::Vector3d& twist) {
  Eigen::Matrix3d hat;
  hat << 0, -twist.z(), twist.x(), twist.z(), 0, twist.y(), 0, 0, 0;
  return hat.exp();
}

/// Ad of X, with (ρ, φ): X exp(b) = exp(Ad b) X.
inline Eigen::Matrix3d adjoint(const Eigen::Matrix3d& X) {
  Eigen::Matrix3d Ad = X;
  Ad.topRightCorner<2, 1>() << X(1, 2), -X(0, 2);
  return Ad;
}

/// Central differences of a motion's (x, y, θ) with respect to three numbers.
inline Eigen::Matrix3d differences(const std::function<Pose(const Eigen::Vector3d&)>& f) {
  constexpr double kStep = 1e-5;
  Eigen::Matrix3d J;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
    Eigen::Vector3d difference = f(d).vector() - f(-d).vector();
    difference.z() = wrap_angle(difference.z());
    J.col(i) = difference / (2.0 * kStep);
  }
  return J;
}

/// What both have: the covariance of the errors of poses 0 … n, and the update.
class NaiveErrorFilter {
 public:
  explicit NaiveErrorFilter(const MeasurementLog& log)
      : poses_{log.origin()}, storage_(zero_state(log)) {}
  virtual ~NaiveErrorFilter() = default;

  void add_keyframe(const RelativePose& step) {
    const RelativePose u = step.forward();
    const auto n = static_cast<Eigen::Index>(3 * poses_.size());
    poses_.push_back(compose(poses_.back(), u.motion));
    Eigen::Matrix3d F;
    Eigen::Matrix3d G;
    propagate(u.motion, F, G);
    auto P = storage_.topLeftCorner(n + 3, n + 3);
    Eigen::MatrixXd last = P.block(n - 3, 0, 3, n);
    last.rightCols<3>() =
        Eigen::Matrix3d(Eigen::Matrix3d(last.rightCols<3>()).selfadjointView<Eigen::Lower>());
    last = (F * last).eval();
    P.bottomLeftCorner(3, n) = last;
    P.bottomRightCorner<3, 3>() =
        last.rightCols<3>() * F.transpose() + G * u.covariance() * G.transpose();
  }

  void close_loops(const std::vector<RelativePose>& registrations) {
    const auto m = static_cast<Eigen::Index>(3 * registrations.size());
    const auto n = static_cast<Eigen::Index>(3 * poses_.size());
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, n);
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd nu(m);
    for (Eigen::Index j = 0; j < m; j += 3) {
      const RelativePose z = registrations[static_cast<std::size_t>(j / 3)].forward();
      H.block<3, 3>(j, static_cast<Eigen::Index>(3 * z.from)) = differences(
          [&](const Eigen::Vector3d& e) { return between(moved(z.from, e), place(z.to)); });
      H.block<3, 3>(j, static_cast<Eigen::Index>(3 * z.to)) = differences(
          [&](const Eigen::Vector3d& e) { return between(place(z.from), moved(z.to, e)); });
      nu.segment<3>(j) = z.motion.vector() - between(poses_[z.from], poses_[z.to]).vector();
      nu(j + 2) = wrap_angle(nu(j + 2));
      R.block<3, 3>(j, j) = z.covariance();
    }
    auto P = storage_.topLeftCorner(n, n);
    const Eigen::MatrixXd PHt = P.selfadjointView<Eigen::Lower>() * H.transpose();
    const Eigen::MatrixXd S = H * PHt + R;
    const Eigen::MatrixXd K = S.ldlt().solve(PHt.transpose()).transpose();
    const Eigen::VectorXd dx = K * nu;
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      correct(k, dx.segment<3>(static_cast<Eigen::Index>(3 * k)));
    }
    joseph(K, PHt, S, P);
  }

  const std::vector<Pose>& trajectory() const { return poses_; }

  /// Of (x, y, θ) of keyframe k.
  Eigen::Matrix3d covariance(std::size_t k) const {
    const auto row = static_cast<Eigen::Index>(3 * k);
    const Eigen::Matrix3d own = storage_.block<3, 3>(row, row).selfadjointView<Eigen::Lower>();
    const Eigen::Matrix3d J = to_world(k);
    return J * own * J.transpose();
  }

 protected:
  virtual void propagate(const Pose& u, Eigen::Matrix3d& F, Eigen::Matrix3d& G) = 0;
  /// Where H is taken, and the pose there with an error.
  virtual Pose place(std::size_t k) const = 0;
  virtual Pose moved(std::size_t k, const Eigen::Vector3d& error) const = 0;
  virtual void correct(std::size_t k, const Eigen::Vector3d& error) = 0;
  virtual Eigen::Matrix3d to_world(std::size_t k) const = 0;

  std::vector<Pose> poses_;

 private:
  Eigen::MatrixXd storage_;  ///< the lower triangle of P in its top left corner
};

/// X = exp(ξ) X̂.
class NaiveInvariantEkf final : public NaiveErrorFilter {
 public:
  using NaiveErrorFilter::NaiveErrorFilter;

 private:
  // X_n T(u + w) = X_{n+1} exp(b) with b = (Rot(u)ᵀ w_p, w_θ).
  void propagate(const Pose& u, Eigen::Matrix3d& F, Eigen::Matrix3d& G) override {
    Eigen::Matrix3d body = Eigen::Matrix3d::Identity();
    body.topLeftCorner<2, 2>() = rotation(u.theta).transpose();
    F.setIdentity();
    G = adjoint(matrix_of(poses_.back())) * body;
  }
  Pose place(std::size_t k) const override { return poses_[k]; }
  Pose moved(std::size_t k, const Eigen::Vector3d& error) const override {
    return pose_of(matrix_exponential(error) * matrix_of(poses_[k]));
  }
  void correct(std::size_t k, const Eigen::Vector3d& error) override {
    poses_[k] = moved(k, error);
  }
  Eigen::Matrix3d to_world(std::size_t k) const override {
    return differences([&](const Eigen::Vector3d& e) { return moved(k, e); });
  }
};

/// Errors of (x, y, θ), every Jacobian at the first estimate of its pose.
class NaiveFirstEstimatesEkf final : public NaiveErrorFilter {
 public:
  explicit NaiveFirstEstimatesEkf(const MeasurementLog& log)
      : NaiveErrorFilter(log), first_{log.origin()} {}

 private:
  // Of X_{n+1} = (p_n + Rot(θ_n) u, θ_n + u_θ), with p_{n+1} − p_n in place of Rot(θ_n) u.
  void propagate(const Pose&, Eigen::Matrix3d& F, Eigen::Matrix3d& G) override {
    const Pose last = poses_[poses_.size() - 2];
    const Eigen::Vector2d way = poses_.back().position() - first_.back().position();
    F.setIdentity();
    F(0, 2) = -way.y();
    F(1, 2) = way.x();
    G.setIdentity();
    G.topLeftCorner<2, 2>() = rotation(last.theta);
    first_.push_back(poses_.back());
  }
  Pose place(std::size_t k) const override { return first_[k]; }
  Pose moved(std::size_t k, const Eigen::Vector3d& error) const override {
    return Pose::from_vector(first_[k].vector() + error);
  }
  void correct(std::size_t k, const Eigen::Vector3d& error) override {
    const Eigen::Vector3d sum = poses_[k].vector() + error;
    poses_[k] = {sum.x(), sum.y(), wrap_angle(sum.z())};
  }
  Eigen::Matrix3d to_world(std::size_t) const override { return Eigen::Matrix3d::Identity(); }

  std::vector<Pose> first_;
};

}  // namespace fathom::test

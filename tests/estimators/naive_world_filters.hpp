#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

/// Textbook filters with absolute measurements and an uncertain start, dense and slow. Keyframe 0
/// is part of the state, whatever its covariance; an absolute measurement is used as it is written,
/// by its own residual. They share with the estimators only ⊕, ⊖ and their Jacobians.
namespace fathom::test {

/// The lower triangle of P, with room for more keyframes: to move all of it for each takes longer
/// than the filter.
class NaiveCovariance {
 public:
  explicit NaiveCovariance(const Eigen::Matrix3d& start) : room_(start), n_(3) {}

  Eigen::Block<Eigen::MatrixXd> P() { return room_.topLeftCorner(n_, n_); }
  Eigen::Block<const Eigen::MatrixXd> P() const { return room_.topLeftCorner(n_, n_); }
  /// By three rows and columns, with anything in them.
  Eigen::Block<Eigen::MatrixXd> grow() {
    n_ += 3;
    if (n_ > room_.rows()) room_.conservativeResize(2 * n_, 2 * n_);
    return P();
  }

 private:
  Eigen::MatrixXd room_;
  Eigen::Index n_;
};

/// ν, H and information W of all that is measured at one time. W may be singular: with A = H P Hᵀ
/// and N = W (I + A W)⁻¹, which is (A + W⁻¹)⁻¹ where that exists, the gain is K = P Hᵀ N and the
/// posterior P − P Hᵀ N H P.
struct NaiveStack {
  Eigen::VectorXd nu;
  Eigen::MatrixXd H;
  Eigen::MatrixXd W;
  Eigen::MatrixXd PHt;
  Eigen::MatrixXd N;

  NaiveStack(std::size_t measurements, Eigen::Index state)
      : nu(3 * static_cast<Eigen::Index>(measurements)),
        H(Eigen::MatrixXd::Zero(nu.size(), state)),
        W(Eigen::MatrixXd::Zero(nu.size(), nu.size())) {}

  /// Of P the lower triangle is read.
  void prepare(const Eigen::Block<Eigen::MatrixXd>& P) {
    PHt = P.selfadjointView<Eigen::Lower>() * H.transpose();
    const Eigen::MatrixXd M = Eigen::MatrixXd::Identity(nu.size(), nu.size()) + H * PHt * W;
    N = M.transpose().partialPivLu().solve(W).transpose();
    N = (0.5 * (N + N.transpose())).eval();
  }

  /// The lower triangle of the posterior.
  void reduce(Eigen::Block<Eigen::MatrixXd> P) const {
    P.triangularView<Eigen::Lower>() -= PHt * N * PHt.transpose();
  }
};

/// ν = −e of an absolute measurement and the Jacobian of e.
inline void naive_absolute(const AbsolutePose& z, const Pose& X, Eigen::Index row,
                           Eigen::Index column, const Eigen::MatrixXd& X_state, NaiveStack& stack) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topLeftCorner<2, 2>() = rotation(z.pose.theta).transpose();
  Eigen::Vector3d e = J * (X.vector() - z.pose.vector());
  e.z() = wrap_angle(X.theta - z.pose.theta);
  stack.nu.segment<3>(row) = -e;
  stack.H.block(row, column, 3, X_state.cols()) = J * X_state;
  stack.W.block<3, 3>(row, row) = z.information;
}

/// The plain EKF on absolute poses 0 … n.
class NaiveWorldEkf {
 public:
  explicit NaiveWorldEkf(const StartPose& start) : x_(start.pose.vector()), P_(start.covariance) {}

  void add_keyframe(const RelativePose& step) {
    const RelativePose u = step.forward();
    const Eigen::Index n = x_.size();
    Eigen::Matrix3d J_pose;
    Eigen::Matrix3d J_motion;
    const Pose next = compose(pose(n / 3 - 1), u.motion, &J_pose, &J_motion);
    Eigen::MatrixXd cross = P_.P().bottomRows<3>();
    cross.rightCols<3>() = last_block();
    cross = (J_pose * cross).eval();
    Eigen::Block<Eigen::MatrixXd> P = P_.grow();
    P.bottomLeftCorner(3, n) = cross;
    P.bottomRightCorner<3, 3>() = cross.rightCols<3>() * J_pose.transpose() +
                                  J_motion * u.covariance() * J_motion.transpose();
    x_.conservativeResize(n + 3);
    x_.tail<3>() = next.vector();
  }

  void update(const KeyframeMeasurements& arrival) {
    NaiveStack stack(arrival.registrations.size() + arrival.absolute.size(), x_.size());
    Eigen::Index row = 0;
    for (const RelativePose& written : arrival.registrations) {
      const RelativePose z = written.forward();
      Eigen::Matrix3d J_from;
      Eigen::Matrix3d J_to;
      const auto a = static_cast<Eigen::Index>(3 * z.from);
      const auto b = static_cast<Eigen::Index>(3 * z.to);
      stack.nu.segment<3>(row) = -residual(z.motion, pose(a / 3), pose(b / 3), &J_from, &J_to);
      stack.H.block<3, 3>(row, a) = J_from;
      stack.H.block<3, 3>(row, b) = J_to;
      stack.W.block<3, 3>(row, row) = z.information;
      row += 3;
    }
    for (const AbsolutePose& z : arrival.absolute) {
      const auto column = static_cast<Eigen::Index>(3 * z.keyframe);
      naive_absolute(z, pose(column / 3), row, column, Eigen::Matrix3d::Identity(), stack);
      row += 3;
    }
    stack.prepare(P_.P());
    x_ += stack.PHt * (stack.N * stack.nu);
    stack.reduce(P_.P());
  }

  std::vector<Pose> trajectory() const {
    std::vector<Pose> poses;
    for (Eigen::Index k = 0; k < x_.size() / 3; ++k) {
      poses.push_back({x_(3 * k), x_(3 * k + 1), wrap_angle(x_(3 * k + 2))});
    }
    return poses;
  }
  Eigen::Matrix3d covariance(std::size_t k) const {
    const auto row = static_cast<Eigen::Index>(3 * k);
    return Eigen::Matrix3d(P_.P().block<3, 3>(row, row)).selfadjointView<Eigen::Lower>();
  }

 private:
  Eigen::Matrix3d last_block() const {
    return Eigen::Matrix3d(P_.P().bottomRightCorner<3, 3>()).selfadjointView<Eigen::Lower>();
  }
  Pose pose(Eigen::Index k) const { return Pose::from_vector(x_.segment<3>(3 * k)); }

  Eigen::VectorXd x_;
  NaiveCovariance P_;
};

/// The paper's trajectory filter, X = [x₁⁰; x₂¹; …] with the start as its first motion.
class NaiveWorldTrajectoryIekf {
 public:
  NaiveWorldTrajectoryIekf(const StartPose& start, int iterations)
      : n_(iterations), x_(start.pose.vector()), P_(start.covariance) {}

  void add_keyframe(const RelativePose& step) {
    const RelativePose u = step.forward();
    const Eigen::Index n = x_.size();
    x_.conservativeResize(n + 3);
    x_.tail<3>() = u.motion.vector();
    Eigen::Block<Eigen::MatrixXd> P = P_.grow();
    P.bottomRows<3>().setZero();
    P.bottomRightCorner<3, 3>() = u.covariance();
  }

  void update(const KeyframeMeasurements& arrival) {
    NaiveStack stack(arrival.registrations.size() + arrival.absolute.size(), x_.size());
    const Eigen::VectorXd x0 = x_;
    Eigen::VectorXd x = x0;
    for (int i = 0; i < n_; ++i) {
      linearise(x, arrival, stack);
      stack.prepare(P_.P());
      x = x0 + stack.PHt * (stack.N * (stack.nu - stack.H * (x0 - x)));
    }
    x_ = x;
    for (Eigen::Index i = 2; i < x_.size(); i += 3) x_(i) = wrap_angle(x_(i));
    stack.reduce(P_.P());
  }

  std::vector<Pose> trajectory() const {
    std::vector<Pose> poses{Pose::from_vector(x_.head<3>())};
    for (Eigen::Index i = 3; i < x_.size(); i += 3) {
      poses.push_back(compose(poses.back(), Pose::from_vector(x_.segment<3>(i))));
    }
    return poses;
  }
  Eigen::Matrix3d covariance(std::size_t k) const {
    const auto [X, J] = chain(x_, 0, k);
    const Eigen::MatrixXd P =
        P_.P().topLeftCorner(J.cols(), J.cols()).selfadjointView<Eigen::Lower>();
    return Eigen::MatrixXd(J * P * J.transpose());
  }

 private:
  // The composition of motions first … last and its Jacobian with respect to them.
  static std::pair<Pose, Eigen::MatrixXd> chain(const Eigen::VectorXd& x, std::size_t first,
                                                std::size_t last) {
    Pose h;
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, static_cast<Eigen::Index>(3 * (last - first + 1)));
    for (std::size_t k = first; k <= last; ++k) {
      Eigen::Matrix3d J_chain;
      Eigen::Matrix3d J_motion;
      h = compose(h, Pose::from_vector(x.segment<3>(static_cast<Eigen::Index>(3 * k))), &J_chain,
                  &J_motion);
      J = (J_chain * J).eval();
      J.middleCols<3>(static_cast<Eigen::Index>(3 * (k - first))) = J_motion;
    }
    return {h, J};
  }

  static void linearise(const Eigen::VectorXd& x, const KeyframeMeasurements& arrival,
                        NaiveStack& stack) {
    stack.H.setZero();
    Eigen::Index row = 0;
    for (const RelativePose& written : arrival.registrations) {
      const RelativePose z = written.forward();
      const auto [h, J] = chain(x, z.from + 1, z.to);
      Eigen::Vector3d nu = z.motion.vector() - h.vector();
      nu.z() = wrap_angle(nu.z());
      stack.nu.segment<3>(row) = nu;
      stack.H.block(row, static_cast<Eigen::Index>(3 * (z.from + 1)), 3, J.cols()) = J;
      stack.W.block<3, 3>(row, row) = z.covariance().inverse();
      row += 3;
    }
    for (const AbsolutePose& z : arrival.absolute) {
      const auto [X, J] = chain(x, 0, z.keyframe);
      naive_absolute(z, X, row, 0, J, stack);
      row += 3;
    }
  }

  int n_;
  Eigen::VectorXd x_;
  NaiveCovariance P_;
};

template <class Filter>
Filter run_naive_in_world(Filter filter, const MeasurementLog& log) {
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (k > 0) filter.add_keyframe(log.arrival(k).step);
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (!arrival.registrations.empty() || !arrival.absolute.empty()) filter.update(arrival);
  }
  return filter;
}

}  // namespace fathom::test

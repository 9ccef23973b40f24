#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

/// Textbook filters, dense and slow, to compare with. They share with the estimators only ⊕, ⊖ and
/// their Jacobians, which are tested against differences.
namespace fathom::test {

/// Room for the covariance of a whole log.
inline Eigen::MatrixXd zero_state(const MeasurementLog& log) {
  const auto n = static_cast<Eigen::Index>(3 * log.size());
  return Eigen::MatrixXd::Zero(n, n);
}

/// The covariance of a Kalman update in Joseph's form, multiplied out:
/// (I − K H) P (I − K H)ᵀ + K R Kᵀ = P − K (P Hᵀ)ᵀ − (P Hᵀ − K S) Kᵀ. Only the lower triangle of P
/// is kept and read: with both, the filter blows up on intel after some hundred loops.
template <class Matrix>
void joseph(const Eigen::MatrixXd& K, const Eigen::MatrixXd& PHt, const Eigen::MatrixXd& S,
            Matrix P) {
  Eigen::MatrixXd left(K.rows(), 2 * K.cols());
  Eigen::MatrixXd right(K.rows(), 2 * K.cols());
  left << K, PHt - K * S;
  right << PHt, K;
  P.template triangularView<Eigen::Lower>() -= left * right.transpose();
}

/// The paper's trajectory filter: X stacks the relative motions.
class NaiveTrajectoryIekf {
 public:
  NaiveTrajectoryIekf(const MeasurementLog& log, int iterations)
      : origin_(log.origin()), n_(iterations), storage_(zero_state(log)) {}

  void add_keyframe(const RelativePose& step) {
    const RelativePose u = step.forward();
    const Eigen::Index n = x_.size();
    x_.conservativeResize(n + 3);
    x_.tail<3>() = u.motion.vector();
    P().bottomRightCorner<3, 3>() = u.covariance();
  }

  void close_loops(const std::vector<RelativePose>& registrations) {
    const auto m = static_cast<Eigen::Index>(3 * registrations.size());
    const Eigen::VectorXd x0 = x_;
    Eigen::VectorXd x = x0;
    Eigen::MatrixXd H(m, x.size());
    Eigen::MatrixXd K;
    Eigen::MatrixXd PHt;
    Eigen::MatrixXd S;
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
    for (int i = 0; i < n_; ++i) {
      Eigen::VectorXd nu(m);
      for (Eigen::Index j = 0; j < m; j += 3) {
        const RelativePose z = registrations[static_cast<std::size_t>(j / 3)].forward();
        const auto [h, Hj] = predict(x, z.from);
        nu.segment<3>(j) = z.motion.vector() - h.vector();
        nu(j + 2) = wrap_angle(nu(j + 2));
        H.middleRows<3>(j) = Hj;
        R.block<3, 3>(j, j) = z.covariance();
      }
      PHt = P().selfadjointView<Eigen::Lower>() * H.transpose();
      S = H * PHt + R;
      K = S.ldlt().solve(PHt.transpose()).transpose();
      x = x0 + K * (nu - H * (x0 - x));
    }
    x_ = x;
    for (Eigen::Index i = 2; i < x_.size(); i += 3) x_(i) = wrap_angle(x_(i));
    joseph(K, PHt, S, P());
  }

  std::vector<Pose> trajectory() const {
    std::vector<Pose> poses{origin_};
    for (Eigen::Index i = 0; i < x_.size(); i += 3) {
      poses.push_back(compose(poses.back(), Pose::from_vector(x_.segment<3>(i))));
    }
    return poses;
  }

 private:
  // h and H by the chain rule, motion after motion.
  std::pair<Pose, Eigen::MatrixXd> predict(const Eigen::VectorXd& x, std::size_t from) const {
    Pose h;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, x.size());
    const auto start = static_cast<Eigen::Index>(3 * from);
    for (Eigen::Index i = start; i < x.size(); i += 3) {
      Eigen::Matrix3d J_chain;
      Eigen::Matrix3d J_motion;
      h = compose(h, Pose::from_vector(x.segment<3>(i)), &J_chain, &J_motion);
      H.middleCols(start, i - start) = (J_chain * H.middleCols(start, i - start)).eval();
      H.middleCols<3>(i) = J_motion;
    }
    return {h, H};
  }

  Eigen::Block<Eigen::MatrixXd> P() { return storage_.topLeftCorner(x_.size(), x_.size()); }

  Pose origin_;
  int n_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd storage_;  ///< the lower triangle of P in its top left corner
};

/// The plain EKF on absolute poses 0 … n, keyframe 0 with zero covariance.
class NaiveEkf {
 public:
  explicit NaiveEkf(const MeasurementLog& log)
      : x_(log.origin().vector()), storage_(zero_state(log)) {}

  void add_keyframe(const RelativePose& step) {
    const RelativePose u = step.forward();
    const Eigen::Index n = x_.size();
    Eigen::Matrix3d J_pose;
    Eigen::Matrix3d J_motion;
    const Pose next = compose(Pose::from_vector(x_.tail<3>()), u.motion, &J_pose, &J_motion);
    Eigen::MatrixXd last_rows = P().bottomRows<3>();
    last_rows.rightCols<3>() =
        P().bottomRightCorner<3, 3>().selfadjointView<Eigen::Lower>() * Eigen::Matrix3d::Identity();
    last_rows = (J_pose * last_rows).eval();
    x_.conservativeResize(n + 3);
    x_.tail<3>() = next.vector();
    P().bottomLeftCorner(3, n) = last_rows;
    P().bottomRightCorner<3, 3>() = last_rows.rightCols<3>() * J_pose.transpose() +
                                    J_motion * u.covariance() * J_motion.transpose();
  }

  void close_loops(const std::vector<RelativePose>& registrations) {
    const auto m = static_cast<Eigen::Index>(3 * registrations.size());
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, x_.size());
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd nu(m);
    for (Eigen::Index j = 0; j < m; j += 3) {
      const RelativePose z = registrations[static_cast<std::size_t>(j / 3)].forward();
      const auto a = static_cast<Eigen::Index>(3 * z.from);
      const auto b = static_cast<Eigen::Index>(3 * z.to);
      Eigen::Matrix3d H_a;
      Eigen::Matrix3d H_b;
      const Pose h = between(Pose::from_vector(x_.segment<3>(a)),
                             Pose::from_vector(x_.segment<3>(b)), &H_a, &H_b);
      H.block<3, 3>(j, a) = H_a;
      H.block<3, 3>(j, b) = H_b;
      nu.segment<3>(j) = z.motion.vector() - h.vector();
      nu(j + 2) = wrap_angle(nu(j + 2));
      R.block<3, 3>(j, j) = z.covariance();
    }
    const Eigen::MatrixXd PHt = P().selfadjointView<Eigen::Lower>() * H.transpose();
    const Eigen::MatrixXd S = H * PHt + R;
    const Eigen::MatrixXd K = S.ldlt().solve(PHt.transpose()).transpose();
    x_ += K * nu;
    joseph(K, PHt, S, P());
  }

  std::vector<Pose> trajectory() const {
    std::vector<Pose> poses;
    for (Eigen::Index i = 0; i < x_.size(); i += 3) {
      poses.push_back(Pose::from_vector(x_.segment<3>(i)));
    }
    return poses;
  }

 private:
  Eigen::Block<Eigen::MatrixXd> P() { return storage_.topLeftCorner(x_.size(), x_.size()); }

  Eigen::VectorXd x_;
  Eigen::MatrixXd storage_;  ///< the lower triangle of P in its top left corner
};

template <class Filter>
std::vector<Pose> run_naive(Filter filter, const MeasurementLog& log) {
  for (std::size_t k = 1; k < log.size(); ++k) {
    filter.add_keyframe(log.arrival(k).step);
    if (!log.arrival(k).registrations.empty()) filter.close_loops(log.arrival(k).registrations);
  }
  return filter.trajectory();
}

}  // namespace fathom::test

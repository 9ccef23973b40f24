#pragma once

#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

/// The paper's trajectory filter with the errors n of all pictures behind its motions, dense and
/// slow: every n is in the state from the beginning, of the prior I, H and K are full matrices, and
/// the covariance is Joseph's. Of a Schmidt-Kalman filter the rows of K at n are zero: that is all.
namespace fathom::test {

class NaiveSharedIekf {
 public:
  NaiveSharedIekf(const MeasurementLog& log, int iterations, bool estimates_n)
      : origin_(log.origin()),
        iterations_(iterations),
        estimates_n_(estimates_n),
        motions_(row(log.size() - 1)),
        x_(Eigen::VectorXd::Zero(motions_ + row(log.size()))),
        P_(Eigen::MatrixXd::Zero(x_.size(), x_.size())) {
    P_.bottomRightCorner(row(log.size()), row(log.size())).setIdentity();
    for (std::size_t k = 1; k < log.size(); ++k) {
      const RelativePose u = log.arrival(k).step.forward();
      x_.segment<3>(row(k - 1)) = u.motion.vector();
      P_.block<3, 3>(row(k - 1), row(k - 1)) = u.covariance();
      if (!log.arrival(k).registrations.empty()) close_loops(log.arrival(k).registrations);
    }
  }

  std::vector<Pose> poses() const {
    std::vector<Pose> poses{origin_};
    for (Eigen::Index i = 0; i < motions_; i += 3) {
      poses.push_back(compose(poses.back(), Pose::from_vector(x_.segment<3>(i))));
    }
    return poses;
  }
  Eigen::Vector3d n(std::size_t k) const { return x_.segment<3>(motions_ + row(k)); }

  /// Of (x, y, θ) of all keyframes but 0, world axes.
  Eigen::MatrixXd covariance() const {
    Eigen::MatrixXd J = Eigen::MatrixXd::Zero(motions_, motions_);
    Pose pose = origin_;
    for (Eigen::Index i = 0; i < motions_; i += 3) {
      Eigen::Matrix3d J_pose;
      Eigen::Matrix3d J_motion;
      pose = compose(pose, Pose::from_vector(x_.segment<3>(i)), &J_pose, &J_motion);
      if (i > 0) J.middleRows<3>(i) = J_pose * J.middleRows<3>(i - 3);
      J.block<3, 3>(i, i) = J_motion;
    }
    return J * P_.topLeftCorner(motions_, motions_) * J.transpose();
  }

 private:
  static Eigen::Index row(std::size_t k) { return static_cast<Eigen::Index>(3 * k); }

  // h and H of the motions from one keyframe to another, by the chain rule.
  std::pair<Pose, Eigen::MatrixXd> predict(const Eigen::VectorXd& x, const RelativePose& z) const {
    Pose h;
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, x.size());
    for (Eigen::Index i = row(z.from); i < row(z.to); i += 3) {
      Eigen::Matrix3d J_chain;
      Eigen::Matrix3d J_motion;
      h = compose(h, Pose::from_vector(x.segment<3>(i)), &J_chain, &J_motion);
      H = (J_chain * H).eval();
      H.middleCols<3>(i) = J_motion;
    }
    return {h, H};
  }

  void close_loops(const std::vector<RelativePose>& registrations) {
    const Eigen::Index m = row(registrations.size());
    Eigen::MatrixXd H(m, x_.size());
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd nu(m);
    Eigen::MatrixXd K;
    Eigen::VectorXd x = x_;
    for (int i = 0; i < iterations_; ++i) {
      for (Eigen::Index j = 0; j < m; j += 3) {
        const RelativePose z = registrations[static_cast<std::size_t>(j / 3)].forward();
        const auto [h, H_motions] = predict(x, z);
        H.middleRows<3>(j) = H_motions;
        nu.segment<3>(j) = z.motion.vector() - h.vector();
        R.block<3, 3>(j, j) = z.shared ? z.shared->own : z.covariance();
        if (z.shared) {
          H.block<3, 3>(j, motions_ + row(z.from)) = z.shared->from.scaled();
          H.block<3, 3>(j, motions_ + row(z.to)) = z.shared->to.scaled();
          nu.segment<3>(j) -=
              H.middleRows<3>(j).rightCols(x.size() - motions_) * x.tail(x.size() - motions_);
        }
        nu(j + 2) = wrap_angle(nu(j + 2));
      }
      K = (H * P_ * H.transpose() + R).ldlt().solve(H * P_).transpose();
      if (!estimates_n_) K.bottomRows(x.size() - motions_).setZero();
      x = x_ + K * (nu - H * (x_ - x));
    }
    x_ = x;
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(P_.rows(), P_.cols()) - K * H;
    P_ = (left * P_ * left.transpose() + K * R * K.transpose()).eval();
  }

  Pose origin_;
  int iterations_;
  bool estimates_n_;
  Eigen::Index motions_;  ///< rows
  Eigen::VectorXd x_;     ///< motions, then n
  Eigen::MatrixXd P_;
};

}  // namespace fathom::test

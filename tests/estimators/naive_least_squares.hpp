#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "fathom/measurements/measurement_log.hpp"

/// A textbook least-squares solver, dense and slow, to compare with. It shares with the estimators
/// only ⊖ and its Jacobians, which are tested against differences.
namespace fathom::test {

/// Dense Gauss-Newton over the poses of F = Σ eᵀ Ω e, all but keyframe 0 unless that is uncertain,
/// and the covariance (Σ Jᵀ Ω J)⁻¹.
struct NaiveLeastSquares {
  std::vector<Pose> poses;
  Eigen::MatrixXd covariance;
  std::size_t first = 1;  ///< keyframe of its first row

  Eigen::Matrix3d marginal(std::size_t k) const {
    if (k < first) return Eigen::Matrix3d::Zero();
    const auto i = static_cast<Eigen::Index>(3 * (k - first));
    return covariance.block<3, 3>(i, i);
  }

  Eigen::MatrixXd joint(const std::vector<std::size_t>& keyframes) const {
    Eigen::MatrixXd chosen =
        Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * keyframes.size()), covariance.cols());
    for (std::size_t i = 0; i < keyframes.size(); ++i) {
      if (keyframes[i] < first) continue;
      chosen.block<3, 3>(static_cast<Eigen::Index>(3 * i),
                         static_cast<Eigen::Index>(3 * (keyframes[i] - first))) =
          Eigen::Matrix3d::Identity();
    }
    return chosen * covariance * chosen.transpose();
  }
};

/// The largest difference of two joint covariances' 3×3 blocks (a, b), as a share of
/// √(‖C_aa‖ ‖C_bb‖); the difference itself where a keyframe has none.
inline double largest_block_difference(const Eigen::MatrixXd& joint,
                                       const Eigen::MatrixXd& expected) {
  double largest = 0.0;
  for (Eigen::Index i = 0; i < expected.rows(); i += 3) {
    for (Eigen::Index j = 0; j < expected.cols(); j += 3) {
      const double difference = (joint.block<3, 3>(i, j) - expected.block<3, 3>(i, j)).norm();
      const double scale =
          std::sqrt(expected.block<3, 3>(i, i).norm() * expected.block<3, 3>(j, j).norm());
      largest = std::max(largest, scale > 0.0 ? difference / scale : difference);
    }
  }
  return largest;
}

inline void add_absolute(const AbsolutePose& z, const Pose& X, Eigen::MatrixXd& A,
                         Eigen::VectorXd& b) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topLeftCorner<2, 2>() = rotation(z.pose.theta).transpose();
  Eigen::Vector3d e = J * (X.vector() - z.pose.vector());
  e.z() = wrap_angle(X.theta - z.pose.theta);
  const auto row = static_cast<Eigen::Index>(3 * z.keyframe);
  A.block<3, 3>(row, row) += J.transpose() * z.information * J;
  b.segment<3>(row) += J.transpose() * z.information * e;
}

/// `poses`: where to begin; none: dead reckoning.
inline NaiveLeastSquares least_squares(const MeasurementLog& log, int iterations,
                                       std::vector<Pose> poses = {}) {
  NaiveLeastSquares result{
      poses.empty() ? log.odometry() : std::move(poses), {}, log.start().is_fixed() ? 1U : 0U};
  const auto held = static_cast<Eigen::Index>(3 * result.first);
  const auto n = static_cast<Eigen::Index>(3 * log.size());
  for (int i = 0; i < iterations; ++i) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(n);
    for (const RelativePose& z : log.edges()) {
      Eigen::Matrix3d J_from;
      Eigen::Matrix3d J_to;
      const Eigen::Vector3d e =
          residual(z.motion, result.poses[z.from], result.poses[z.to], &J_from, &J_to);
      Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, n);
      J.middleCols<3>(static_cast<Eigen::Index>(3 * z.from)) = J_from;
      J.middleCols<3>(static_cast<Eigen::Index>(3 * z.to)) = J_to;
      A += J.transpose() * z.information * J;
      b += J.transpose() * z.information * e;
    }
    for (std::size_t k = 0; k < log.size(); ++k) {
      for (const AbsolutePose& z : log.arrival(k).absolute) {
        add_absolute(z, result.poses[k], A, b);
      }
    }
    add_absolute(log.start().measurement(), result.poses[0], A, b);
    const Eigen::MatrixXd free = A.bottomRightCorner(n - held, n - held);
    const Eigen::VectorXd dx = -free.ldlt().solve(b.tail(n - held));
    for (std::size_t k = result.first; k < log.size(); ++k) {
      const Eigen::Vector3d moved =
          result.poses[k].vector() +
          dx.segment<3>(static_cast<Eigen::Index>(3 * (k - result.first)));
      result.poses[k] = {moved.x(), moved.y(), wrap_angle(moved.z())};
    }
    result.covariance = free.inverse();
  }
  return result;
}

}  // namespace fathom::test

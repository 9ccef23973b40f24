#include "naive_least_squares.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <Eigen/Dense>

namespace fathom::conformance {
namespace {

/// A dx = −b, keyframe 0 among the unknowns.
struct NormalEquations {
  Eigen::MatrixXd A;
  Eigen::VectorXd b;
};

Eigen::Index row_of(std::size_t k) {
  return static_cast<Eigen::Index>(3 * k);
}

void add_relative(const RelativePose& z, const std::vector<Pose>& poses,
                  NormalEquations& equations) {
  Eigen::Matrix3d J_from;
  Eigen::Matrix3d J_to;
  const Eigen::Vector3d e = residual(z.motion, poses[z.from], poses[z.to], &J_from, &J_to);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(3, equations.b.size());
  J.middleCols<3>(row_of(z.from)) = J_from;
  J.middleCols<3>(row_of(z.to)) = J_to;
  equations.A += J.transpose() * z.information * J;
  equations.b += J.transpose() * z.information * e;
}

void add_absolute(const AbsolutePose& z, const Pose& X, NormalEquations& equations) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J.topLeftCorner<2, 2>() = rotation(z.pose.theta).transpose();
  Eigen::Vector3d e = J * (X.vector() - z.pose.vector());
  e.z() = wrap_angle(X.theta - z.pose.theta);
  const Eigen::Index row = row_of(z.keyframe);
  equations.A.block<3, 3>(row, row) += J.transpose() * z.information * J;
  equations.b.segment<3>(row) += J.transpose() * z.information * e;
}

// All registrations that are told what they share, as one measurement: e = −Dᵀ ν, D =
// diag(Rot(θ_z), 1), and Cov ν of two of them is what one picture does to both.
void add_sharing(const std::vector<RelativePose>& sharing, const std::vector<Pose>& poses,
                 NormalEquations& equations) {
  const Eigen::Index rows = row_of(sharing.size());
  Eigen::MatrixXd C = Eigen::MatrixXd::Zero(rows, rows);
  Eigen::MatrixXd J = Eigen::MatrixXd::Zero(rows, equations.b.size());
  Eigen::VectorXd e(rows);
  const auto ends = [](const RelativePose& z) {
    const Eigen::Matrix3d D = planar_rotation(z.motion.theta).transpose();
    return std::array{std::pair{z.from, (D * z.shared->from.scaled()).eval()},
                      std::pair{z.to, (D * z.shared->to.scaled()).eval()}};
  };
  for (std::size_t i = 0; i < sharing.size(); ++i) {
    const RelativePose& z = sharing[i];
    Eigen::Matrix3d J_from;
    Eigen::Matrix3d J_to;
    e.segment<3>(row_of(i)) = residual(z.motion, poses[z.from], poses[z.to], &J_from, &J_to);
    J.block<3, 3>(row_of(i), row_of(z.from)) = J_from;
    J.block<3, 3>(row_of(i), row_of(z.to)) = J_to;
    const Eigen::Matrix3d D = planar_rotation(z.motion.theta);
    C.block<3, 3>(row_of(i), row_of(i)) = D.transpose() * z.shared->own * D;
    for (std::size_t j = 0; j < sharing.size(); ++j) {
      for (const auto& [a, G_a] : ends(z)) {
        for (const auto& [b, G_b] : ends(sharing[j])) {
          if (a == b) C.block<3, 3>(row_of(i), row_of(j)) += G_a * G_b.transpose();
        }
      }
    }
  }
  const Eigen::LDLT<Eigen::MatrixXd> factor(C);
  equations.A += J.transpose() * factor.solve(J);
  equations.b += J.transpose() * factor.solve(e);
}

NormalEquations linearised(const MeasurementLog& log, const std::vector<Pose>& poses,
                           RegistrationErrors errors) {
  const Eigen::Index n = row_of(log.size());
  NormalEquations equations{Eigen::MatrixXd::Zero(n, n), Eigen::VectorXd::Zero(n)};
  std::vector<RelativePose> sharing;
  for (const RelativePose& z : log.edges()) {
    if (z.shared && errors == RegistrationErrors::shared) {
      sharing.push_back(z);
    } else {
      add_relative(z, poses, equations);
    }
  }
  add_sharing(sharing, poses, equations);
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const AbsolutePose& z : log.arrival(k).absolute) add_absolute(z, poses[k], equations);
  }
  add_absolute(log.start().measurement(), poses[0], equations);
  return equations;
}

}  // namespace

Eigen::Matrix3d NaiveLeastSquares::marginal(std::size_t k) const {
  if (k < first) return Eigen::Matrix3d::Zero();
  return covariance.block<3, 3>(row_of(k - first), row_of(k - first));
}

Eigen::MatrixXd NaiveLeastSquares::joint(const std::vector<std::size_t>& keyframes) const {
  Eigen::MatrixXd chosen = Eigen::MatrixXd::Zero(row_of(keyframes.size()), covariance.cols());
  for (std::size_t i = 0; i < keyframes.size(); ++i) {
    if (keyframes[i] < first) continue;
    chosen.block<3, 3>(row_of(i), row_of(keyframes[i] - first)) = Eigen::Matrix3d::Identity();
  }
  return chosen * covariance * chosen.transpose();
}

UncertainPose NaiveLeastSquares::motion_to_newest(std::size_t k) const {
  Eigen::Matrix<double, 3, 6> J;
  Eigen::Matrix3d J_k;
  Eigen::Matrix3d J_newest;
  UncertainPose motion;
  motion.mean = between(poses[k], poses.back(), &J_k, &J_newest);
  J << J_k, J_newest;
  motion.covariance = J * joint({k, poses.size() - 1}) * J.transpose();
  return motion;
}

double largest_block_difference(const Eigen::MatrixXd& joint, const Eigen::MatrixXd& expected) {
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

NaiveLeastSquares least_squares(const MeasurementLog& log, int iterations, std::vector<Pose> poses,
                                RegistrationErrors errors) {
  NaiveLeastSquares result{
      poses.empty() ? log.odometry() : std::move(poses), {}, log.start().is_fixed() ? 1U : 0U};
  const Eigen::Index free = row_of(log.size() - result.first);
  for (int i = 0; i < iterations; ++i) {
    const NormalEquations equations = linearised(log, result.poses, errors);
    const Eigen::MatrixXd A = equations.A.bottomRightCorner(free, free);
    const Eigen::VectorXd dx = -A.ldlt().solve(equations.b.tail(free));
    for (std::size_t k = result.first; k < log.size(); ++k) {
      const Eigen::Vector3d at = result.poses[k].vector() + dx.segment<3>(row_of(k - result.first));
      result.poses[k] = {at.x(), at.y(), wrap_angle(at.z())};
    }
    result.covariance = A.inverse();
  }
  return result;
}

}  // namespace fathom::conformance

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Dense>

#include "tests/estimators/naive_error_filters.hpp"

/// The textbook filter on poses and the errors n of all pictures, dense and slow: every n is in the
/// state from the beginning, of the prior I, H and K are full matrices, and the covariance is
/// Joseph's. Of a Schmidt-Kalman filter the rows of K at n are zero: that is all.
namespace fathom::test {

enum class NaiveError { world, invariant, first_estimates };

class NaiveSharedFilter {
 public:
  NaiveSharedFilter(const MeasurementLog& log, NaiveError kind, bool estimates_n)
      : kind_(kind),
        estimates_n_(estimates_n),
        all_(log.size()),
        poses_{log.origin()},
        first_{log.origin()},
        n_(Eigen::VectorXd::Zero(row(all_))),
        P_(Eigen::MatrixXd::Zero(2 * row(all_), 2 * row(all_))) {
    P_.bottomRightCorner(row(all_), row(all_)).setIdentity();
    for (std::size_t k = 0; k < log.size(); ++k) {
      if (k > 0) add_keyframe(log.arrival(k).step.forward());
      if (!log.arrival(k).registrations.empty()) close_loops(log.arrival(k).registrations);
    }
  }

  const std::vector<Pose>& poses() const { return poses_; }
  Eigen::Vector3d n(std::size_t k) const { return n_.segment<3>(row(k)); }

  /// Of (x, y, θ) of all keyframes.
  Eigen::MatrixXd covariance() const {
    Eigen::MatrixXd to_world = Eigen::MatrixXd::Zero(row(all_), row(all_));
    for (std::size_t k = 0; k < all_; ++k) {
      to_world.block<3, 3>(row(k), row(k)) = world_from_error(k);
    }
    return to_world * P_.topLeftCorner(row(all_), row(all_)) * to_world.transpose();
  }

 private:
  static Eigen::Index row(std::size_t k) { return static_cast<Eigen::Index>(3 * k); }

  // About a centre: [I  J p].
  static Eigen::Matrix3d turning(const Eigen::Vector2d& p) {
    Eigen::Matrix3d G = Eigen::Matrix3d::Identity();
    G(0, 2) = -p.y();
    G(1, 2) = p.x();
    return G;
  }

  Eigen::Matrix3d world_from_error(std::size_t k) const {
    if (kind_ != NaiveError::invariant) return Eigen::Matrix3d::Identity();
    return turning(poses_[k].position());
  }

  const Pose& place(std::size_t k) const {
    return kind_ == NaiveError::first_estimates ? first_[k] : poses_[k];
  }

  void add_keyframe(const RelativePose& u) {
    const std::size_t k = poses_.size();
    Eigen::Matrix3d F;
    Eigen::Matrix3d J;
    poses_.push_back(compose(poses_[k - 1], u.motion, &F, &J));
    first_.push_back(poses_[k]);
    if (kind_ == NaiveError::invariant) {
      F.setIdentity();
      J = world_from_error(k).inverse() * J;
    } else if (kind_ == NaiveError::first_estimates) {
      F = turning(first_[k].position() - first_[k - 1].position());
    }
    P_.middleRows<3>(row(k)) = F * P_.middleRows<3>(row(k - 1));
    P_.middleCols<3>(row(k)) = P_.middleCols<3>(row(k - 1)) * F.transpose();
    P_.block<3, 3>(row(k), row(k)) = F * P_.block<3, 3>(row(k - 1), row(k - 1)) * F.transpose() +
                                     J * u.covariance() * J.transpose();
  }

  void close_loops(const std::vector<RelativePose>& registrations) {
    const Eigen::Index m = row(registrations.size());
    Eigen::MatrixXd H = Eigen::MatrixXd::Zero(m, P_.cols());
    Eigen::MatrixXd R = Eigen::MatrixXd::Zero(m, m);
    Eigen::VectorXd nu(m);
    for (Eigen::Index j = 0; j < m; j += 3) {
      const RelativePose z = registrations[static_cast<std::size_t>(j / 3)].forward();
      Eigen::Matrix3d H_from;
      Eigen::Matrix3d H_to;
      between(place(z.from), place(z.to), &H_from, &H_to);
      H.block<3, 3>(j, row(z.from)) = H_from * world_from_error(z.from);
      H.block<3, 3>(j, row(z.to)) = H_to * world_from_error(z.to);
      nu.segment<3>(j) = z.motion.vector() - between(poses_[z.from], poses_[z.to]).vector();
      R.block<3, 3>(j, j) = z.shared ? z.shared->own : z.covariance();
      if (z.shared) {
        H.block<3, 3>(j, row(all_ + z.from)) = z.shared->from.G * z.shared->from.sigma.asDiagonal();
        H.block<3, 3>(j, row(all_ + z.to)) = z.shared->to.G * z.shared->to.sigma.asDiagonal();
        nu.segment<3>(j) -= H.middleRows<3>(j).rightCols(row(all_)) * n_;
      }
      nu(j + 2) = wrap_angle(nu(j + 2));
    }
    const Eigen::MatrixXd S = H * P_ * H.transpose() + R;
    Eigen::MatrixXd K = S.ldlt().solve(H * P_).transpose();
    if (!estimates_n_) K.bottomRows(row(all_)).setZero();
    correct(K * nu);
    const Eigen::MatrixXd left = Eigen::MatrixXd::Identity(P_.rows(), P_.cols()) - K * H;
    P_ = (left * P_ * left.transpose() + K * R * K.transpose()).eval();
  }

  void correct(const Eigen::VectorXd& dx) {
    for (std::size_t k = 0; k < poses_.size(); ++k) {
      const Eigen::Vector3d error = dx.segment<3>(row(k));
      if (kind_ == NaiveError::invariant) {
        poses_[k] = pose_of(matrix_exponential(error) * matrix_of(poses_[k]));
      } else {
        poses_[k] = Pose::from_vector(poses_[k].vector() + error);
      }
    }
    n_ += dx.tail(row(all_));
  }

  NaiveError kind_;
  bool estimates_n_;
  std::size_t all_;
  std::vector<Pose> poses_;
  std::vector<Pose> first_;
  Eigen::VectorXd n_;
  Eigen::MatrixXd P_;  ///< of poses, then of n
};

}  // namespace fathom::test

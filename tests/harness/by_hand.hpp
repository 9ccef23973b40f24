#pragma once

#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom::test {

inline Eigen::Matrix3d matrix_of(const Eigen::Vector3d& x) {
  Eigen::Matrix3d T;
  T << std::cos(x.z()), -std::sin(x.z()), x.x(),  //
      std::sin(x.z()), std::cos(x.z()), x.y(),    //
      0.0, 0.0, 1.0;
  return T;
}

inline Eigen::Vector3d vector_of(const Eigen::Matrix3d& T) {
  return {T(0, 2), T(1, 2), std::atan2(T(1, 0), T(0, 0))};
}

template <class Function>
Eigen::MatrixXd derivative(const Function& function, const Eigen::VectorXd& at) {
  constexpr double kStep = 1e-6;
  Eigen::MatrixXd J(function(at).size(), at.size());
  for (Eigen::Index i = 0; i < at.size(); ++i) {
    const Eigen::VectorXd step = kStep * Eigen::VectorXd::Unit(at.size(), i);
    J.col(i) = (function(at + step) - function(at - step)) / (2.0 * kStep);
  }
  return J;
}

/// Batch least squares over a small log by what is written down first: SE(2) in matrices,
/// derivatives by differences, and dense matrices. Keyframe 0 is fixed; x has three rows a keyframe
/// from 1 on.
class ByHand {
 public:
  explicit ByHand(const MeasurementLog& log) : first_(log.origin().vector()), edges_(log.edges()) {
    const std::vector<Pose> start = log.odometry();
    x_.resize(3 * static_cast<Eigen::Index>(start.size() - 1));
    for (std::size_t k = 1; k < start.size(); ++k) x_.segment<3>(row_of(k)) = start[k].vector();
    for (int i = 0; i < 20; ++i) step();
  }

  /// eᵀ (J_e Σ J_eᵀ + Ω⁻¹)⁻¹ e.
  double nis(const RelativePose& z) const {
    const auto e_of = [&](const Eigen::VectorXd& x) { return error(z, x); };
    const Eigen::Vector3d e = e_of(x_);
    const Eigen::MatrixXd J = derivative(e_of, x_);
    const Eigen::Matrix3d S = J * information_.inverse() * J.transpose() + z.information.inverse();
    return e.dot(S.inverse() * e);
  }

  Eigen::Vector3d error(const RelativePose& z) const { return error(z, x_); }

 private:
  static Eigen::Index row_of(std::size_t k) { return 3 * static_cast<Eigen::Index>(k) - 3; }

  Eigen::Matrix3d pose(std::size_t k, const Eigen::VectorXd& x) const {
    return matrix_of(k == 0 ? first_ : Eigen::Vector3d(x.segment<3>(row_of(k))));
  }

  Eigen::Vector3d error(const RelativePose& z, const Eigen::VectorXd& x) const {
    return vector_of(matrix_of(z.motion.vector()).inverse() * pose(z.from, x).inverse() *
                     pose(z.to, x));
  }

  void step() {
    information_ = Eigen::MatrixXd::Zero(x_.size(), x_.size());
    Eigen::VectorXd gradient = Eigen::VectorXd::Zero(x_.size());
    for (const RelativePose& z : edges_) {
      const auto e_of = [&](const Eigen::VectorXd& x) { return error(z, x); };
      const Eigen::MatrixXd J = derivative(e_of, x_);
      information_ += J.transpose() * z.information * J;
      gradient += J.transpose() * z.information * e_of(x_);
    }
    x_ -= information_.ldlt().solve(gradient);
  }

  Eigen::Vector3d first_;
  std::vector<RelativePose> edges_;
  Eigen::VectorXd x_;
  Eigen::MatrixXd information_;
};

}  // namespace fathom::test

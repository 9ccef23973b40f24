#pragma once

// The restricted likelihood as textbooks have it, from dense matrices of the whole survey in ν =
// z − h(x), so that tests do not check the sparse one against itself.

#include <vector>

#include <Eigen/Dense>

#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom::test {

class DenseLikelihood {
 public:
  /// With the σ that the registrations tell; without holes.
  DenseLikelihood(const MeasurementLog& log, const std::vector<Pose>& poses)
      : log_(log), poses_(poses), unknowns_(3 * log.size()) {
    if (!log.start().is_fixed() && !log.start().is_free) add(log.start().measurement());
    for (std::size_t k = 0; k < log.size(); ++k) {
      const KeyframeMeasurements& arrival = log.arrival(k);
      if (k > 0 && !arrival.step.is_hole) add(arrival.step);
      for (const RelativePose& z : arrival.registrations) add(z);
      for (const AbsolutePose& z : arrival.absolute) add(z);
    }
  }

  /// −½ (log|C| + log|Jᵀ C⁻¹ J| + rᵀ P r).
  double value() const { return solved().value; }
  /// rᵀ P r.
  double chi2() const { return solved().chi2; }

 private:
  struct Solved {
    double value;
    double chi2;
  };

  Solved solved() const {
    const auto rows = static_cast<Eigen::Index>(rows_.size());
    const auto first = log_.start().is_fixed() ? 3 : 0;
    const auto poses = static_cast<Eigen::Index>(unknowns_) - first;
    Eigen::MatrixXd J(rows, poses);
    Eigen::MatrixXd G(rows, static_cast<Eigen::Index>(unknowns_));
    Eigen::MatrixXd C = Eigen::MatrixXd::Zero(rows, rows);
    Eigen::VectorXd r(rows);
    for (Eigen::Index i = 0; i < rows; ++i) {
      const Row& row = rows_[static_cast<std::size_t>(i)];
      J.row(i) = row.J.tail(poses).transpose();
      G.row(i) = row.G.transpose();
      r[i] = row.r;
      for (int j = 0; j < row.size; ++j) C(i, i - row.at + j) = row.C[j];
    }
    C += G * G.transpose();
    const Eigen::LLT<Eigen::MatrixXd> C_factor(C);
    const Eigen::MatrixXd information = J.transpose() * C_factor.solve(J);
    const Eigen::LLT<Eigen::MatrixXd> J_factor(information);
    const Eigen::VectorXd estimate = J_factor.solve(J.transpose() * C_factor.solve(r));
    const Eigen::VectorXd left = r - J * estimate;
    const double chi2 = left.dot(C_factor.solve(left));
    return {-0.5 * (log_determinant(C_factor) + log_determinant(J_factor) + chi2), chi2};
  }

  struct Row {
    Eigen::VectorXd J;
    Eigen::VectorXd G;
    Eigen::Vector3d C;  // its row of the own covariance, the row itself at `at`
    int size = 3;
    int at = 0;
    double r = 0.0;
  };

  static double log_determinant(const Eigen::LLT<Eigen::MatrixXd>& factor) {
    return 2.0 * Eigen::MatrixXd(factor.matrixL()).diagonal().array().log().sum();
  }

  Row empty_row() const {
    const auto size = static_cast<Eigen::Index>(unknowns_);
    return {Eigen::VectorXd::Zero(size), Eigen::VectorXd::Zero(size), Eigen::Vector3d::Zero()};
  }

  void add(const RelativePose& z) {
    Eigen::Matrix3d h_from;
    Eigen::Matrix3d h_to;
    Eigen::Vector3d nu =
        z.motion.vector() - between(poses_[z.from], poses_[z.to], &h_from, &h_to).vector();
    nu.z() = wrap_angle(nu.z());
    const Eigen::Matrix3d C = z.shared ? z.shared->own : z.covariance();
    const auto from = static_cast<Eigen::Index>(3 * z.from);
    const auto to = static_cast<Eigen::Index>(3 * z.to);
    for (int i = 0; i < 3; ++i) {
      Row row = empty_row();
      row.J.segment<3>(from) = h_from.row(i).transpose();
      row.J.segment<3>(to) = h_to.row(i).transpose();
      if (z.shared) {
        row.G.segment<3>(from) = z.shared->from.scaled().row(i).transpose();
        row.G.segment<3>(to) = z.shared->to.scaled().row(i).transpose();
      }
      row.C = C.row(i).transpose();
      row.at = i;
      row.r = nu[i];
      rows_.push_back(row);
    }
  }

  void add(const AbsolutePose& z) {
    Eigen::Matrix3d J;
    const Eigen::Vector3d e = residual(z, poses_[z.keyframe], &J);
    const InformationRows measured = rows_of(z.information);
    for (int i = 0; i < measured.rank; ++i) {
      Row row = empty_row();
      row.J.segment<3>(static_cast<Eigen::Index>(3 * z.keyframe)) =
          -(measured.rows.row(i) * J).transpose();
      row.C[0] = measured.variances[i];
      row.size = 1;
      row.r = measured.rows.row(i).dot(e);
      rows_.push_back(row);
    }
  }

  const MeasurementLog& log_;
  const std::vector<Pose>& poses_;
  std::size_t unknowns_;
  std::vector<Row> rows_;
};

}  // namespace fathom::test

#pragma once

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/SparseCore>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// A log linearised at a trajectory: whitened residuals c + B y of all that is measured, y = (δ of
/// the poses that are not held, n of the pictures). A row of n is the altitude (m), the roll or the
/// pitch (rad) of a picture that a told registration in use has; its prior is not among the rows.
class JointRows {
 public:
  using Index = Eigen::Index;

  /// `used` by registration in order of arrival; empty: all.
  JointRows(const MeasurementLog& log, std::span<const Pose> trajectory,
            const std::vector<bool>& used);

  const Eigen::SparseMatrix<double>& B() const { return B_; }
  const Eigen::VectorXd& c() const { return c_; }
  Index poses() const { return poses_; }  ///< unknowns of the poses, which come first
  Index unknowns() const { return unknowns_; }
  double log_own() const { return log_own_; }  ///< log determinant of what was whitened by
  /// Whether all of it is finite; also not where a covariance is not positive definite.
  bool is_finite() const;

  /// By registration in order of arrival, its first of three rows; −1: not used.
  const std::vector<Index>& registrations() const { return registrations_; }
  /// First row of n of keyframe k's picture, if it has any, and what is told of its σ.
  std::optional<Index> picture(std::size_t k) const;
  /// First of three rows of each told registration in use.
  const std::vector<Index>& told() const { return told_; }
  const Eigen::Vector3d& told_sigma(std::size_t k) const { return sigma_of_[k]; }

  /// The trajectory moved by δ.
  std::vector<Pose> moved(std::span<const Pose> trajectory, const Eigen::VectorXd& y) const;

 private:
  struct Block {
    Index column;
    Eigen::Matrix3d J;
  };

  void add(const RelativePose& z, std::span<const Pose> trajectory);
  void add(const AbsolutePose& z, const Pose& X);
  void add_rows(const Eigen::Vector3d& e, std::span<const Block> blocks, int rows);
  Index pose_column(std::size_t k) const;
  Index picture_column(std::size_t k, const PictureErrors& errors);

  bool is_first_held_ = false;
  Index poses_ = 0;
  Index unknowns_ = 0;
  std::vector<Index> picture_;  // by keyframe, −1: none
  std::vector<Eigen::Vector3d> sigma_of_;
  std::vector<Eigen::Triplet<double>> elements_;
  std::vector<double> residuals_;
  double log_own_ = 0.0;
  std::vector<Index> told_;
  std::vector<Index> registrations_;
  Eigen::SparseMatrix<double> B_;
  Eigen::VectorXd c_;
};

}  // namespace fathom

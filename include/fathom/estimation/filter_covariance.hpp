#pragma once

#include <Eigen/Core>

namespace fathom {

/// The dense symmetric covariance of a filter whose state grows by blocks of three. Only the lower
/// triangle is stored and touched, so it is symmetric by construction.
class FilterCovariance {
 public:
  /// Rows of the state: three per block.
  Eigen::Index size() const { return size_; }

  /// A new block, uncorrelated with the rest.
  void append(const Eigen::Matrix3d& covariance);

  /// A new block with its 3×size() cross covariance to the rest.
  void append(const Eigen::Matrix3Xd& cross, const Eigen::Matrix3d& covariance);

  /// The 3×3 block of block row i and block column j.
  Eigen::Matrix3d block(Eigen::Index i, Eigen::Index j) const;

  /// All rows of block column j: size()×3.
  Eigen::MatrixX3d column(Eigen::Index j) const;

  /// P(:, first block …) · B for B with size() − 3·first rows, that is, P times a matrix which is
  /// zero above block `first`: size()×cols. `tail_times` gives the rows from `first` on only.
  Eigen::MatrixXd times(Eigen::Index first, const Eigen::MatrixXd& B) const;
  Eigen::MatrixXd tail_times(Eigen::Index first, const Eigen::MatrixXd& B) const;

  /// P ← P − Wᵀ W for W with size() columns. With W = L⁻¹ (P Hᵀ)ᵀ and S = L Lᵀ it is the Kalman
  /// update, symmetric and without a general inverse; P − (P Hᵀ) S⁻¹ (P Hᵀ)ᵀ by a general solve
  /// loses definiteness after some hundred loops.
  void downdate(const Eigen::MatrixXd& W);

  /// The whole matrix, both triangles.
  Eigen::MatrixXd full() const;

 private:
  void reserve(Eigen::Index rows);

  Eigen::MatrixXd storage_;  ///< at least size_ rows and columns
  Eigen::Index size_ = 0;
};

}  // namespace fathom

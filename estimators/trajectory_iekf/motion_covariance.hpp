#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/filter/packed_covariance.hpp"
#include "estimators/trajectory_iekf/loop_factors.hpp"

namespace fathom {

/// The covariance of the stacked motions, and of errors of pictures among them (StateBlocks): a
/// block of the state is called a motion here.
///
///     P = diag(C, Q_{c+1}, …, Q_n) − Σ V Vᵀ,
///
/// with C dense, of the first c motions, the Q of the later ones as they were appended, and a
/// factor V for each update since. Dense is c = n without factors; the form for few loops is c = 0.
/// Which is cheaper hangs on the loops (docs/estimators/trajectory_iekf.md).
class MotionCovariance {
 public:
  enum class Form {
    cheapest,   ///< the factors are folded into C once passes over them cost more than C would
    dense,      ///< folded after every update
    few_loops,  ///< folded only where pictures need it
  };

  explicit MotionCovariance(Form form = Form::cheapest) : form_(form) {}

  /// Rows: three per motion.
  Eigen::Index size() const;

  /// A new motion, independent of those before it.
  void append(const Eigen::Matrix3d& Q);

  /// Motion i anew, uncorrelated with the others.
  void replace(Eigen::Index i, const Eigen::Matrix3d& Q);

  /// Motion i anew, with its size()×3 column: correlated with pictures. Folds.
  void replace(Eigen::Index i, const Eigen::MatrixX3d& column);

  /// All rows of the columns of motion i: size()×3.
  Eigen::MatrixX3d column(Eigen::Index i) const;

  /// P(:, blocks) B, all rows; B has three rows for each block.
  Eigen::MatrixXd products(std::span<const Eigen::Index> blocks, const Eigen::MatrixXd& B) const;

  /// P(:, …) B over the ends of B: as PackedCovariance::suffix_products. `pass` counts the calls
  /// for one update, from 1: after the first, `product` has its third columns from the call before,
  /// with the same third column of B.
  void suffix_products(std::span<const Eigen::Index> starts, const Eigen::MatrixX3d& B,
                       Eigen::Ref<Eigen::MatrixXd> product, int pass = 1) const;

  /// The same for the rows of motions first_correlated(start) … start − 1, start = starts.front().
  Eigen::MatrixXd head_products(std::span<const Eigen::Index> starts,
                                const Eigen::MatrixX3d& B) const;

  /// The first motion, counted from 0, that any from `start` on is correlated with.
  Eigen::Index first_correlated(Eigen::Index start) const;

  /// P ← P − V Vᵀ after so many passes: see PackedCovariance. V ends with the newest motion.
  void downdate(const Eigen::Ref<const Eigen::MatrixXd>& V, int passes = 1);

  /// The same, but for the blocks of two of `kept`, which stay: PackedCovariance::downdate_but.
  /// What stays has no factor, so this folds.
  void downdate_but(std::span<const Eigen::Index> kept, const Eigen::Ref<const Eigen::MatrixXd>& V);

  /// Of each motion k, Σ B_iᵀ P_ij B_j over all motions i, j up to k, or from k on.
  enum class Over { motions_up_to, motions_from };
  std::vector<Eigen::Matrix3d> congruences(const Eigen::MatrixX3d& B, Over over) const;

  /// The whole matrix, for tests.
  Eigen::MatrixXd full() const;

  /// Motions whose covariance is dense.
  Eigen::Index dense_motions() const { return dense_.size() / 3; }
  /// Memory held.
  std::size_t bytes() const;

 private:
  bool is_cheaper_dense(std::size_t numbers_in_factors) const;
  void fold();
  void subtract_congruences(const Eigen::MatrixX3d& B, Over over,
                            std::vector<Eigen::Matrix3d>& sums) const;

  Form form_;
  filter::PackedCovariance dense_;      ///< C
  std::vector<Eigen::Matrix3d> later_;  ///< Q of the motions after those of C
  LoopFactors factors_;
};

}  // namespace fathom

#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/filter/growing_memory.hpp"
#include "estimators/support/filter/scratch.hpp"

namespace fathom::filter {

/// V of an update P ← P − V Vᵀ, zero outside rows first_row … first_row + V.rows().
struct DowndateFactor {
  Eigen::Index first_row = 0;
  Eigen::MatrixXd V;

  Eigen::Index end_row() const { return first_row + V.rows(); }
};

/// Whether a pass over a triangle starts with its first rows or with its last. For what the cache
/// still holds, and for rounding, it matters; for nothing else.
enum class PassOrder { forward, backward };

/// The dense symmetric covariance of a filter whose state grows by blocks of three. Only the lower
/// triangle is stored and touched, so it is symmetric by construction. It grows without being
/// copied; every pass below reads the triangle once, in the order in which it lies in memory
/// (docs/estimators/trajectory_iekf.md).
class PackedCovariance {
 public:
  /// Rows of the state: three per block.
  Eigen::Index size() const { return size_; }

  /// A new block, uncorrelated with the rest.
  void append(const Eigen::Matrix3d& covariance);

  /// A new block with its 3×size() cross covariance to the rest.
  void append(const Eigen::Matrix3Xd& cross, const Eigen::Matrix3d& covariance);

  /// Block i anew, uncorrelated with the rest.
  void replace(Eigen::Index i, const Eigen::Matrix3d& covariance);

  /// Block i anew, with its size()×3 column.
  void replace(Eigen::Index i, const Eigen::MatrixX3d& column);

  /// The 3×3 block of block row i and block column j.
  Eigen::Matrix3d block(Eigen::Index i, Eigen::Index j) const;

  /// All rows of block column j: size()×3.
  Eigen::MatrixX3d column(Eigen::Index j) const;

  /// P times the ends of one B. With B (size() − 3·starts.front())×3, whose row 0 is that of block
  /// starts.front(), and `starts` rising: columns 3s … 3s + 2 of `product` become Σ P(:, i) B(i)
  /// over the blocks i ≥ starts[s]. Rows from block starts.front() on; `head_products` has the rows
  /// above. All starts are served by one pass. With columns_of_B = 2 the third columns are left as
  /// they are.
  ///
  /// Not from two threads at once: they share what the sums take.
  void suffix_products(std::span<const Eigen::Index> starts,
                       const Eigen::Ref<const Eigen::MatrixX3d>& B,
                       Eigen::Ref<Eigen::MatrixXd> product, int columns_of_B = 3,
                       PassOrder order = PassOrder::forward) const;
  void head_products(std::span<const Eigen::Index> starts,
                     const Eigen::Ref<const Eigen::MatrixX3d>& B,
                     Eigen::Ref<Eigen::MatrixXd> product) const;

  /// Of block row k of P, times B of size() rows: Σ P(k, j) B(j) over the blocks before the
  /// diagonal and over those after it; 3×3 each, stacked to size()×3.
  struct Sides {
    Eigen::MatrixX3d before;
    Eigen::MatrixX3d after;
  };
  Sides side_products(const Eigen::Ref<const Eigen::MatrixX3d>& B) const;

  /// P ← P − V Vᵀ, V being zero but for its rows from first_row on. With V = P Hᵀ L⁻ᵀ and S = L Lᵀ
  /// it is the Kalman update, symmetric and without a general inverse; P − (P Hᵀ) S⁻¹ (P Hᵀ)ᵀ by a
  /// general solve loses definiteness after some hundred loops.
  void downdate(const Eigen::Ref<const Eigen::MatrixXd>& V, Eigen::Index first_row = 0,
                PassOrder order = PassOrder::forward);

  /// Several at once, one after the other; none reaches beyond size().
  void downdate(std::span<const DowndateFactor> factors);

  /// The first, but for the blocks of two of `kept`, rising, which stay: the Schmidt-Kalman update,
  /// with those blocks what is considered and not estimated. They are uncorrelated with each other.
  void downdate_but(std::span<const Eigen::Index> kept, const Eigen::Ref<const Eigen::MatrixXd>& V);

  /// The whole matrix, both triangles.
  Eigen::MatrixXd full() const;

  /// Memory held.
  std::size_t bytes() const { return memory_.bytes() + scratch_.bytes(); }

 private:
  void downdate_rows(std::size_t panel, Eigen::Index first_row,
                     const Eigen::Ref<const Eigen::MatrixXd>& V);
  /// Panels that have rows from `row` on.
  std::vector<std::size_t> panels_from(Eigen::Index row, PassOrder order) const;
  double* element(Eigen::Index row, Eigen::Index column);
  const double* element(Eigen::Index row, Eigen::Index column) const;

  GrowingMemory memory_;
  /// Panels of rows, from column 0 to the end of the diagonal tile; the tile has both triangles.
  /// What lies beyond size() is zero.
  std::vector<double*> panels_;
  Eigen::Index size_ = 0;
  mutable Scratch scratch_;
};

}  // namespace fathom::filter

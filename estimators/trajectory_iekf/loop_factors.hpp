#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/filter/packed_covariance.hpp"

namespace fathom {

/// What past loops have taken from a covariance, Σ V Vᵀ, a factor V for each update: never
/// multiplied out. Its cost is by loops times motions. Each V has three columns per loop.
class LoopFactors {
 public:
  void add(filter::DowndateFactor factor);
  void clear();
  /// Rows row … row + 2 of all factors become zero.
  void clear_rows(Eigen::Index row);

  bool is_empty() const { return factors_.empty(); }
  std::span<const filter::DowndateFactor> factors() const { return factors_; }
  /// Numbers held.
  std::size_t size() const { return size_; }
  std::size_t bytes() const { return size_ * sizeof(double); }

  /// The first row that the factors correlate with rows from `row` on; `row` if none before.
  Eigen::Index first_correlated(Eigen::Index row) const;

  /// Vᵀ B of all factors stacked, over the ends of B: as PackedCovariance::suffix_products; a row
  /// for each column of each V, 3 columns per start.
  Eigen::MatrixXd transposed_suffix_products(std::span<const Eigen::Index> starts,
                                             const Eigen::MatrixX3d& B) const;

  /// product −= V Y of all factors; `product` has the rows from `first_row` on.
  void subtract_products(const Eigen::MatrixXd& Y, Eigen::Index first_row,
                         Eigen::Ref<Eigen::MatrixXd> product) const;

 private:
  std::vector<filter::DowndateFactor> factors_;
  std::size_t size_ = 0;
  Eigen::Index columns_ = 0;
};

}  // namespace fathom

#pragma once

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/filter/picture_error_states.hpp"

namespace fathom {

/// Which block of the state is whose: the motions, in order, and among them the errors n of
/// pictures, each behind all that was there when it came. Without pictures motion i is block i.
class StateBlocks {
 public:
  Eigen::Index size() const {
    return static_cast<Eigen::Index>(motions_.size() + pictures_.blocks().size());
  }
  bool are_motions_alone() const { return pictures_.blocks().empty(); }

  void add_motion() { motions_.push_back(size()); }
  void add_picture(std::size_t k) { pictures_.add(k, size()); }

  Eigen::Index of_motion(std::size_t i) const { return motions_[i]; }
  filter::PictureErrorStates& pictures() { return pictures_; }
  const filter::PictureErrorStates& pictures() const { return pictures_; }

  /// Rows of the motions from `first` on, as rows of the state from block `begin` on: zero for
  /// pictures, and for motions before `first`.
  Eigen::MatrixX3d spread(Eigen::MatrixX3d motions, std::size_t first, Eigen::Index begin) const;
  /// Of the last blocks of the state, those of the motions from `first` on.
  Eigen::VectorXd motions_in(const Eigen::VectorXd& state, std::size_t first) const;
  /// Sums of every block: those of motions.
  std::vector<Eigen::Matrix3d> motions_in(std::vector<Eigen::Matrix3d> sums) const;

 private:
  std::vector<Eigen::Index> motions_;
  filter::PictureErrorStates pictures_;
};

/// ∂z/∂n of registrations stacked, n in units of σ, for the pictures that any is told of.
struct PictureJacobian {
  std::vector<Eigen::Index> blocks;  ///< of the state, rising
  Eigen::MatrixXd G;                 ///< three rows a registration, three columns a block

  bool is_empty() const { return blocks.empty(); }
  /// G X, for X of the blocks of the state from `begin` on.
  Eigen::MatrixXd times(const Eigen::Ref<const Eigen::MatrixXd>& X, Eigen::Index begin) const;
};

}  // namespace fathom

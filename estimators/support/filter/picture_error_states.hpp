#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include <Eigen/Core>

namespace fathom::filter {

/// The errors n that a picture's registrations share, in units of σ, as a filter has them beside
/// its poses: which block of P is whose, and n̂. A picture is one of a keyframe.
class PictureErrorStates {
 public:
  bool has(std::size_t k) const { return k < pictures_.size() && pictures_[k].block >= 0; }
  /// Of a picture that it has.
  Eigen::Index block_of(std::size_t k) const { return pictures_[k].block; }
  const Eigen::Vector3d& estimate(std::size_t k) const { return pictures_[k].estimate; }

  /// n of keyframe k, n̂ = 0, with the block behind all others.
  void add(std::size_t k, Eigen::Index block) {
    if (pictures_.size() <= k) pictures_.resize(k + 1);
    pictures_[k].block = block;
    blocks_.push_back(block);
  }

  /// Adds their part of an error of the whole state.
  void correct(const Eigen::VectorXd& dx) {
    for (Picture& picture : pictures_) {
      if (picture.block >= 0) picture.estimate += dx.segment<3>(3 * picture.block);
    }
  }

  /// All blocks, rising.
  std::span<const Eigen::Index> blocks() const { return blocks_; }

 private:
  struct Picture {
    Eigen::Index block = -1;
    Eigen::Vector3d estimate = Eigen::Vector3d::Zero();
  };

  std::vector<Picture> pictures_;  ///< by keyframe, as far as there are any
  std::vector<Eigen::Index> blocks_;
};

}  // namespace fathom::filter

#include "estimators/trajectory_iekf/stretch.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fathom/geometry/trajectory.hpp"

namespace fathom {

Stretch::Stretch(std::size_t first, std::span<const Pose> motions)
    : first_(first), first_pose_(first), poses_(compose_trajectory(Pose{}, motions)) {}

Stretch::Stretch(const MotionTree& tree, std::size_t first, std::span<const Pose> motions)
    : first_(first), first_pose_(0), tree_(&tree), poses_(tree.poses(Pose{}, motions)) {}

std::vector<MotionTree::Part> Stretch::way(std::size_t from) const {
  if (tree_ == nullptr) return {{from, newest(), 1.0}};
  return tree_->way(from, newest(), newest());
}

Pose Stretch::h(std::size_t from) const {
  return between(pose(from), poses_.back());
}

// A translation of a motion acts along the axes of the keyframe it leads from; a turn swings the
// rest of the way, as far as keyframe n, about the one it leads to.
Eigen::MatrixX3d Stretch::A_transposed() const {
  const std::size_t n = newest();
  Eigen::MatrixX3d A(static_cast<Eigen::Index>(3 * (n - first_)), 3);
  for (std::size_t i = first_; i < n; ++i) {
    const auto [from, to] = tree_ == nullptr ? MotionTree::Ends{i, i + 1} : tree_->ends(i);
    const auto row = static_cast<Eigen::Index>(3 * (i - first_));
    const double c = std::cos(pose(from).theta);
    const double s = std::sin(pose(from).theta);
    A.row(row) << c, s, 0.0;
    A.row(row + 1) << -s, c, 0.0;
    A.row(row + 2) << pose(to).y - poses_.back().y, poses_.back().x - pose(to).x, 1.0;
  }
  return A;
}

Eigen::Matrix3d Stretch::D(std::size_t from) const {
  return planar_rotation(pose(from).theta);
}

Eigen::Matrix3Xd Stretch::H(std::size_t from) const {
  const Eigen::Matrix3Xd whole = D(from).transpose() * A_transposed().transpose();
  Eigen::Matrix3Xd H = Eigen::Matrix3Xd::Zero(3, whole.cols());
  for (const MotionTree::Part& part : way(from)) {
    const auto begin = static_cast<Eigen::Index>(3 * (part.begin - first_));
    const auto columns = static_cast<Eigen::Index>(3 * (part.end - part.begin));
    H.middleCols(begin, columns) = part.sign * whole.middleCols(begin, columns);
  }
  return H;
}

StackedJacobian::StackedJacobian(const Stretch& stretch, std::span<const Rows> registrations)
    : A_transposed_(stretch.A_transposed()) {
  const Eigen::Index end = static_cast<Eigen::Index>(stretch.first()) + A_transposed_.rows() / 3;
  std::vector<std::vector<MotionTree::Part>> ways;
  for (const Rows& z : registrations) {
    ways.push_back(stretch.way(z.from));
    for (const MotionTree::Part& part : ways.back()) {
      starts_.push_back(static_cast<Eigen::Index>(part.begin));
      if (static_cast<Eigen::Index>(part.end) < end) {
        starts_.push_back(static_cast<Eigen::Index>(part.end));
      }
    }
  }
  std::sort(starts_.begin(), starts_.end());
  starts_.erase(std::unique(starts_.begin(), starts_.end()), starts_.end());
  E_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * starts_.size()),
                             static_cast<Eigen::Index>(3 * registrations.size()));
  for (std::size_t j = 0; j < registrations.size(); ++j) {
    const Rows& z = registrations[j];
    Eigen::Matrix3d D = stretch.D(z.from);
    if (z.C != nullptr) D = (D * z.C->transpose()).eval();
    const auto block_of = [&](std::size_t motion) {
      const auto start =
          std::lower_bound(starts_.begin(), starts_.end(), static_cast<Eigen::Index>(motion));
      return E_.block<3, 3>(3 * (start - starts_.begin()), static_cast<Eigen::Index>(3 * j));
    };
    for (const MotionTree::Part& part : ways[j]) {
      block_of(part.begin) += part.sign * D;
      if (static_cast<Eigen::Index>(part.end) < end) block_of(part.end) -= part.sign * D;
    }
  }
}

// The first start moves to the earliest n: A is zero between.
void StackedJacobian::place_in(const StateBlocks& state, PictureJacobian pictures) {
  pictures_ = std::move(pictures);
  if (state.are_motions_alone()) return;
  const auto first = static_cast<std::size_t>(starts_.front());
  for (Eigen::Index& start : starts_) start = state.of_motion(static_cast<std::size_t>(start));
  if (!pictures_.is_empty()) {
    starts_.front() = std::min(starts_.front(), pictures_.blocks.front());
  }
  A_transposed_ = state.spread(A_transposed_, first, starts_.front());
}

// A X over the motions from each start on, segment after segment from the last; then Eᵀ of it.
Eigen::MatrixXd StackedJacobian::times(const Eigen::Ref<const Eigen::MatrixXd>& X) const {
  Eigen::MatrixXd sums(E_.rows(), X.cols());
  Eigen::Matrix3Xd sum = Eigen::Matrix3Xd::Zero(3, X.cols());
  Eigen::Index end = X.rows();
  for (std::size_t s = starts_.size(); s-- > 0;) {
    const Eigen::Index rows = end - row_of(s);
    sum.noalias() +=
        A_transposed_.middleRows(row_of(s), rows).transpose() * X.middleRows(row_of(s), rows);
    sums.middleRows<3>(static_cast<Eigen::Index>(3 * s)) = sum;
    end = row_of(s);
  }
  if (pictures_.is_empty()) return E_.transpose() * sums;
  return E_.transpose() * sums + pictures_.times(X, starts_.front());
}

Eigen::VectorXd StackedJacobian::transposed_times(const Eigen::VectorXd& lambda) const {
  const Eigen::VectorXd E_lambda = E_ * lambda;
  Eigen::VectorXd product(A_transposed_.rows());
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t s = 0; s < starts_.size(); ++s) {
    sum += E_lambda.segment<3>(static_cast<Eigen::Index>(3 * s));
    const Eigen::Index end = s + 1 < starts_.size() ? row_of(s + 1) : product.size();
    const Eigen::Index rows = end - row_of(s);
    product.segment(row_of(s), rows).noalias() = A_transposed_.middleRows(row_of(s), rows) * sum;
  }
  for (std::size_t b = 0; b < pictures_.blocks.size(); ++b) {
    product.segment<3>(3 * (pictures_.blocks[b] - starts_.front())) =
        pictures_.G.middleCols<3>(static_cast<Eigen::Index>(3 * b)).transpose() * lambda;
  }
  return product;
}

}  // namespace fathom

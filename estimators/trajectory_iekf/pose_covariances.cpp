// The covariances of poses and motions, from that of the stacked motions.

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

// B, three rows a motion: with B_iᵀ δx_i the motion of keyframe 0's place, carried along with
// keyframe i, for a change of motion i. It is the same for all keyframes that come later.
Eigen::MatrixX3d TrajectoryIekf::motions_at_origin() const {
  Eigen::MatrixX3d B = Eigen::MatrixX3d::Zero(P_.size(), 3);
  const Eigen::Vector2d origin = poses_.front().position();
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    const auto [from, to] = tree_.ends(i);
    const Eigen::Vector2d lever = origin - poses_[to].position();
    const Eigen::Index row = 3 * blocks_.of_motion(i);
    B.block<2, 2>(row, 0) = rotation(-poses_[from].theta);
    B.block<2, 1>(row, 2).setZero();
    B.row(row + 2) << -lever.y(), lever.x(), 1.0;
  }
  return B;
}

// The change of a keyframe's pose for one of keyframe 0's place carried along with it.
Eigen::Matrix3d TrajectoryIekf::from_origin_to(std::size_t keyframe) const {
  const Eigen::Vector2d lever = poses_[keyframe].position() - poses_.front().position();
  Eigen::Matrix3d to_keyframe = Eigen::Matrix3d::Identity();
  to_keyframe.topRightCorner<2, 1>() << -lever.y(), lever.x();
  return to_keyframe;
}

// Rows of B for the motions on the way from keyframe 0, zero for others.
Eigen::MatrixX3d TrajectoryIekf::on_way_to(std::size_t keyframe, const Eigen::MatrixX3d& B) const {
  Eigen::MatrixX3d on_way = Eigen::MatrixX3d::Zero(B.rows(), 3);
  for (const MotionTree::Part& part : tree_.way(0, keyframe, motions_.size())) {
    const Eigen::Index begin = 3 * blocks_.of_motion(part.begin);
    const Eigen::Index rows = 3 * blocks_.of_motion(part.end - 1) + 3 - begin;
    on_way.middleRows(begin, rows) = part.sign * B.middleRows(begin, rows);
  }
  return on_way;
}

// Of each keyframe Σ B_iᵀ P_ij B_j over the motions on the way from the root. Keyframe after
// keyframe in depth-first order: of the pairs that one adds, those with others on its way come from
// its columns of P.
std::vector<Eigen::Matrix3d> TrajectoryIekf::congruences_from(std::size_t root,
                                                              const Eigen::MatrixX3d& B) const {
  std::vector<Eigen::Matrix3d> sums(poses_.size(), Eigen::Matrix3d::Zero());
  std::vector<MotionTree::Visit> visit_of(poses_.size());
  Eigen::MatrixX3d on_way = Eigen::MatrixX3d::Zero(B.rows(), 3);
  std::vector<std::size_t> way{root};
  for (const MotionTree::Visit& v : tree_.from(root, motions_.size())) {
    visit_of[v.keyframe] = v;
    const Eigen::Index row = 3 * blocks_.of_motion(v.motion);
    if (way.back() != v.from) {
      const MotionTree::Visit& last = visit_of[v.from];
      for (; way.back() != last.from; way.pop_back()) {
        on_way.middleRows<3>(3 * blocks_.of_motion(visit_of[way.back()].motion)).setZero();
      }
      const Eigen::Index last_row = 3 * blocks_.of_motion(last.motion);
      on_way.middleRows<3>(last_row) = (last.is_along ? 1.0 : -1.0) * B.middleRows<3>(last_row);
      way.push_back(v.from);
    }
    const Eigen::MatrixX3d column = P_.column(blocks_.of_motion(v.motion));
    const Eigen::Matrix3d own = (v.is_along ? 1.0 : -1.0) * B.middleRows<3>(row);
    const Eigen::Matrix3d cross = own.transpose() * (column.transpose() * on_way);
    sums[v.keyframe] = sums[v.from] + transport(own.transpose(), column.middleRows<3>(row)) +
                       cross + cross.transpose();
  }
  return sums;
}

// Σ B_iᵀ P_ij B_j over the motions on the way to k, taken from keyframe 0's place to keyframe k.
void TrajectoryIekf::compute_covariances() const {
  covariances_.assign(1, Eigen::Matrix3d::Zero());
  auto sums = tree_.is_chain() ? blocks_.motions_in(P_.congruences(
                                     motions_at_origin(), MotionCovariance::Over::motions_up_to))
                               : congruences_from(0, motions_at_origin());
  if (!tree_.is_chain()) sums.erase(sums.begin());
  for (std::size_t k = 0; k < sums.size(); ++k) {
    covariances_.push_back(transport(from_origin_to(k + 1), sums[k]));
  }
}

std::optional<Eigen::Matrix3d> TrajectoryIekf::covariance(std::size_t k) const {
  if (covariances_.empty()) compute_covariances();
  return covariances_[k];
}

// J P Jᵀ, a product with P for each keyframe: B on the way to it, zero elsewhere.
std::optional<Eigen::MatrixXd> TrajectoryIekf::joint_covariance(
    std::span<const std::size_t> keyframes) const {
  const std::vector<std::size_t> free = free_keyframes(keyframes);
  const auto size = static_cast<Eigen::Index>(3 * free.size());
  Eigen::MatrixXd joint(size, size);
  const Eigen::MatrixX3d B = motions_at_origin();
  const Eigen::Index start = 0;
  Eigen::MatrixXd product(B.rows(), 3);
  for (std::size_t j = 0; j < free.size(); ++j) {
    P_.suffix_products(std::span(&start, 1), on_way_to(free[j], B), product);
    const Eigen::Matrix3d to_j = from_origin_to(free[j]);
    for (std::size_t i = 0; i <= j; ++i) {
      const Eigen::Index rows =
          tree_.is_chain() ? 3 * blocks_.of_motion(free[i] - 1) + 3 : B.rows();
      const Eigen::MatrixX3d B_i = on_way_to(free[i], B);
      joint.block<3, 3>(static_cast<Eigen::Index>(3 * i), static_cast<Eigen::Index>(3 * j)) =
          from_origin_to(free[i]) * (B_i.topRows(rows).transpose() * product.topRows(rows)) *
          to_j.transpose();
    }
  }
  return in_order_of(keyframes, joint);
}

// H P Hᵀ with the H of each stretch: all have the same A.
std::optional<std::vector<UncertainPose>> TrajectoryIekf::motions_to_newest() const {
  if (motions_.empty()) return std::vector<UncertainPose>{};
  const auto length = static_cast<Eigen::Index>(3 * motions_.size());
  const Stretch stretch = stretch_at(tree_, motions_, 0, Eigen::VectorXd::Zero(length));
  const Eigen::MatrixX3d B = blocks_.spread(stretch.A_transposed(), 0, 0);
  const auto sums =
      tree_.is_chain() ? blocks_.motions_in(P_.congruences(B, MotionCovariance::Over::motions_from))
                       : congruences_from(motions_.size(), B);
  std::vector<UncertainPose> motions;
  for (std::size_t k = 0; k < motions_.size(); ++k) {
    motions.push_back({stretch.h(k), transport(stretch.D(k).transpose(), sums[k])});
  }
  return motions;
}

}  // namespace fathom

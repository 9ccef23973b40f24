// Errors that the registrations of a picture share, in the state of TrajectoryIekf.

#include <algorithm>

#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "fathom/estimation/precision.hpp"

namespace fathom {

// n of both pictures enters the state, unless it is there: n̂ = 0, of the prior I, uncorrelated.
void TrajectoryIekf::admit(const RelativePose& z) {
  if (!is_told(z, model())) return;
  for (const std::size_t k : {z.from, z.to}) {
    if (blocks_.pictures().has(k)) continue;
    blocks_.add_picture(k);
    P_.append(Eigen::Matrix3d::Identity());
  }
}

// By what R is in the update.
bool TrajectoryIekf::are_resolved_as_used(std::span<const RelativePose> registrations) const {
  const Eigen::Vector3d none = Eigen::Vector3d::Zero();
  return std::ranges::all_of(registrations, [&](const RelativePose& z) {
    return is_resolved(is_told(z, model()) ? without_shared(z, none) : z, poses_[z.from],
                       poses_[z.to]);
  });
}

// The first block of the stretch: of its motions and of n of its pictures.
Eigen::Index TrajectoryIekf::begin_of(std::span<const StackedLoop> loops) const {
  Eigen::Index begin = blocks_.of_motion(first_of(loops));
  for (const StackedLoop& loop : loops) {
    if (!loop.shared) continue;
    for (const std::size_t k : {loop.from, loop.to}) {
      begin = std::min(begin, blocks_.pictures().block_of(k));
    }
  }
  return begin;
}

Stretch TrajectoryIekf::stretch_of(std::span<const StackedLoop> loops,
                                   const Eigen::VectorXd& delta) const {
  const std::size_t first = first_of(loops);
  if (blocks_.are_motions_alone()) return stretch_at(tree_, motions_, first, delta);
  return stretch_at(tree_, motions_, first, blocks_.motions_in(delta, first));
}

// Of a motion. n, linear in the measurement, is settled when they are.
double TrajectoryIekf::largest_change(std::span<const StackedLoop> loops,
                                      const Eigen::VectorXd& change) const {
  if (blocks_.are_motions_alone()) return change.cwiseAbs().maxCoeff();
  return blocks_.motions_in(change, first_of(loops)).cwiseAbs().maxCoeff();
}

// z − h(x) − G n at x⁰ + δ and n⁰ + δ_n.
Eigen::VectorXd TrajectoryIekf::innovations_of(std::span<const StackedLoop> loops,
                                               const Stretch& stretch,
                                               const Eigen::VectorXd& delta) const {
  Eigen::VectorXd nu = innovations(loops, stretch);
  const Eigen::Index begin = blocks_.size() - delta.size() / 3;
  const auto n = [&](std::size_t k) -> Eigen::Vector3d {
    const filter::PictureErrorStates& pictures = blocks_.pictures();
    return pictures.estimate(k) + delta.segment<3>(3 * (pictures.block_of(k) - begin));
  };
  for (std::size_t j = 0; j < loops.size(); ++j) {
    const StackedLoop& loop = loops[j];
    if (!loop.shared) continue;
    auto own = nu.segment<3>(static_cast<Eigen::Index>(3 * j));
    own -= loop.shared->from.scaled() * n(loop.from) + loop.shared->to.scaled() * n(loop.to);
    own.z() = wrap_angle(own.z());
  }
  return nu;
}

StackedJacobian TrajectoryIekf::jacobian_of(std::span<const StackedLoop> loops,
                                            const Stretch& stretch) const {
  StackedJacobian H = jacobian(loops, stretch);
  if (!blocks_.are_motions_alone()) {
    H.place_in(blocks_, picture_jacobian(loops, blocks_.pictures()));
  }
  return H;
}

// P Gᵀ of n, all rows; nothing where none is told of any.
Eigen::MatrixXd TrajectoryIekf::picture_products() const {
  const PictureJacobian& n = at_.H.pictures();
  if (n.is_empty()) return {};
  return P_.products(n.blocks, n.G.transpose());
}

// The motion m = z − G n̂ of a loop, or z, with the error −G δn − ν: correlated with n, and by it
// with whatever n is.
void TrajectoryIekf::take_place(std::size_t motion, const StackedLoop& loop) {
  const Eigen::Index block = blocks_.of_motion(motion);
  motions_[motion] = loop.motion;
  if (!loop.shared) return P_.replace(block, loop.rows.R);
  const filter::PictureErrorStates& n = blocks_.pictures();
  motions_[motion] = moved(loop.motion, -loop.shared->from.scaled() * n.estimate(loop.from) -
                                            loop.shared->to.scaled() * n.estimate(loop.to));
  const Eigen::Matrix3d of_n = at_.H.pictures().times(at_.PGt, 0);
  Eigen::MatrixX3d column = -at_.PGt;
  column.middleRows<3>(3 * block) = 0.5 * (of_n + of_n.transpose()) + loop.rows.R;
  P_.replace(block, column);
}

}  // namespace fathom

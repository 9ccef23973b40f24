#include "estimators/trajectory_iekf/stacked_loops.hpp"

#include <algorithm>

#include "fathom/estimation/gate.hpp"

namespace fathom {

StackedLoop::StackedLoop(const RelativePose& forward, SharedErrorModel model)
    : from(forward.from), to(forward.to), motion(forward.motion) {
  if (is_told(forward, model)) {
    shared = forward.shared;
    rows.R = shared->own;
  } else {
    rows = loop_rows(forward);
  }
}

bool is_told(const RelativePose& z, SharedErrorModel model) {
  return z.shared != nullptr && model != SharedErrorModel::independent;
}

std::vector<StackedLoop> stacked(std::span<const RelativePose> loops, SharedErrorModel model) {
  std::vector<StackedLoop> result;
  for (const RelativePose& loop : loops) result.emplace_back(loop.forward(), model);
  return result;
}

std::size_t first_motion(std::span<const StackedLoop> loops, const MotionTree& tree,
                         std::size_t motions) {
  std::size_t first = motions;
  for (const StackedLoop& loop : loops) {
    first = std::min(first, tree.way(loop.from, motions, motions).front().begin);
  }
  return first;
}

Pose moved(const Pose& motion, const Eigen::Vector3d& delta) {
  return {motion.x + delta.x(), motion.y + delta.y(), wrap_angle(motion.theta + delta.z())};
}

namespace {

Eigen::Vector3d innovation(const StackedLoop& loop, const Stretch& stretch) {
  Eigen::Vector3d nu = loop.motion.vector() - stretch.h(loop.from).vector();
  nu.z() = wrap_angle(nu.z());
  return loop.rows.is_whole() ? nu : loop.rows.C * nu;
}

}  // namespace

Eigen::VectorXd innovations(std::span<const StackedLoop> loops, const Stretch& stretch) {
  Eigen::VectorXd nu(static_cast<Eigen::Index>(3 * loops.size()));
  for (std::size_t j = 0; j < loops.size(); ++j) {
    nu.segment<3>(static_cast<Eigen::Index>(3 * j)) = innovation(loops[j], stretch);
  }
  return nu;
}

StackedJacobian jacobian(std::span<const StackedLoop> loops, const Stretch& stretch) {
  std::vector<StackedJacobian::Rows> rows;
  for (const StackedLoop& loop : loops) {
    rows.push_back({loop.from, loop.rows.is_whole() ? nullptr : &loop.rows.C});
  }
  return {stretch, rows};
}

PictureJacobian picture_jacobian(std::span<const StackedLoop> loops,
                                 const filter::PictureErrorStates& pictures) {
  PictureJacobian jacobian;
  std::vector<Eigen::Index>& blocks = jacobian.blocks;
  for (const StackedLoop& loop : loops) {
    if (!loop.shared) continue;
    blocks.push_back(pictures.block_of(loop.from));
    blocks.push_back(pictures.block_of(loop.to));
  }
  if (blocks.empty()) return jacobian;
  std::sort(blocks.begin(), blocks.end());
  blocks.erase(std::unique(blocks.begin(), blocks.end()), blocks.end());
  jacobian.G = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(3 * loops.size()),
                                     static_cast<Eigen::Index>(3 * blocks.size()));
  for (std::size_t j = 0; j < loops.size(); ++j) {
    const StackedLoop& loop = loops[j];
    if (!loop.shared) continue;
    const auto of = [&](std::size_t picture) {
      const auto block = std::ranges::lower_bound(blocks, pictures.block_of(picture));
      return jacobian.G.block<3, 3>(static_cast<Eigen::Index>(3 * j), 3 * (block - blocks.begin()));
    };
    of(loop.from) = loop.shared->from.scaled();
    of(loop.to) = loop.shared->to.scaled();
  }
  return jacobian;
}

double misfit(std::span<const StackedLoop> loops, const Eigen::VectorXd& nu) {
  double sum = 0.0;
  for (std::size_t j = 0; j < loops.size(); ++j) {
    sum += normalised_innovation_squared(nu.segment<3>(static_cast<Eigen::Index>(3 * j)),
                                         loops[j].rows.R);
  }
  return sum;
}

Stretch stretch_at(const MotionTree& tree, const std::vector<Pose>& motions, std::size_t first,
                   const Eigen::VectorXd& delta) {
  const std::size_t kept = tree.is_chain() ? 0 : first;
  std::vector<Pose> at(motions.begin() + static_cast<std::ptrdiff_t>(first - kept), motions.end());
  for (std::size_t i = kept; i < at.size(); ++i) {
    at[i] = moved(at[i], delta.segment<3>(static_cast<Eigen::Index>(3 * (i - kept))));
  }
  if (tree.is_chain()) return {first, at};
  return {tree, first, at};
}

}  // namespace fathom

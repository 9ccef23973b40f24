// The errors that pictures share as blocks of the problem.

#include "estimators/ceres_pose_graph/edge_cost.hpp"
#include "estimators/ceres_pose_graph/graph.hpp"
#include "estimators/ceres_pose_graph/hessian_inverse.hpp"

namespace fathom {

bool CeresPoseGraph::Graph::estimates_errors(const RelativePose& z) const {
  return z.shared != nullptr && options_.shared.model == SharedErrorModel::states;
}

double* CeresPoseGraph::Graph::errors(std::size_t keyframe) {
  if (errors_of_.size() <= keyframe) errors_of_.resize(keyframe + 1);
  std::optional<std::size_t>& index = errors_of_[keyframe];
  if (!index) {
    index = unknowns_.errors.size();
    unknowns_.errors.push_back({0.0, 0.0, 0.0});
    problem_.AddResidualBlock(new ErrorsCost, nullptr, unknowns_.errors.back().data());
  }
  return unknowns_.errors[*index].data();
}

Eigen::Vector3d CeresPoseGraph::Graph::errors_at(std::size_t keyframe) const {
  if (keyframe >= errors_of_.size() || !errors_of_[keyframe]) return Eigen::Vector3d::Zero();
  return Eigen::Vector3d(unknowns_.errors[*errors_of_[keyframe]].data());
}

std::optional<std::size_t> CeresPoseGraph::Graph::errors_block(std::size_t keyframe) const {
  if (keyframe >= errors_of_.size() || !errors_of_[keyframe]) return std::nullopt;
  return size() - 1 + *errors_of_[keyframe];
}

RelativePose CeresPoseGraph::Graph::without_errors(const RelativePose& z) const {
  if (!estimates_errors(z)) return z;
  return without_shared(
      z, z.shared->from.scaled() * errors_at(z.from) + z.shared->to.scaled() * errors_at(z.to));
}

std::vector<RelativePose> CeresPoseGraph::Graph::without_errors(
    std::span<const RelativePose> registrations) const {
  std::vector<RelativePose> apart;
  for (const RelativePose& z : registrations) apart.push_back(without_errors(z));
  return apart;
}

ceres::ResidualBlockId CeresPoseGraph::Graph::add_residual(const RelativePose& z,
                                                           ceres::LossFunction* loss) {
  double* const from = block(z.from);
  double* const to = block(z.to);
  if (!estimates_errors(z)) return problem_.AddResidualBlock(new EdgeCost(z), loss, from, to);
  return problem_.AddResidualBlock(new SharedEdgeCost(z), loss, from, to, errors(z.from),
                                   errors(z.to));
}

// J P Jᵀ over the poses and the errors that a loop is of. A picture without errors among the
// unknowns is as its prior says, and uncorrelated.
std::optional<std::vector<Eigen::Matrix3d>> CeresPoseGraph::Graph::predicted_with_errors(
    std::span<const RelativePose> forward_loops) {
  const auto whole = jacobian();
  if (!whole) return std::nullopt;
  std::vector<Eigen::Matrix3d> predicted;
  for (const RelativePose& z : forward_loops) {
    Eigen::Matrix3d S = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d H_from;
    Eigen::Matrix3d H_to;
    between(pose(z.from), pose(z.to), &H_from, &H_to);
    std::vector<std::size_t> blocks{z.to - 1};
    std::vector<Eigen::Matrix3d> jacobians{H_to};
    const auto add = [&](std::size_t block, const Eigen::Matrix3d& jacobian) {
      blocks.push_back(block);
      jacobians.push_back(jacobian);
    };
    const auto add_errors = [&](std::size_t keyframe, const Eigen::Matrix3d& G) {
      if (const auto block = errors_block(keyframe)) {
        add(*block, G);
      } else {
        S += G * G.transpose();
      }
    };
    if (z.from > 0) add(z.from - 1, H_from);
    if (estimates_errors(z)) {
      add_errors(z.from, z.shared->from.scaled());
      add_errors(z.to, z.shared->to.scaled());
    }
    const auto joint = inverse_between(*whole, blocks);
    if (!joint) return std::nullopt;
    Eigen::Matrix3Xd J(3, joint->rows());
    for (std::size_t i = 0; i < jacobians.size(); ++i) {
      J.middleCols<3>(static_cast<Eigen::Index>(3 * i)) = jacobians[i];
    }
    S += J * *joint * J.transpose();
    predicted.push_back(0.5 * (S + S.transpose()));
  }
  return predicted;
}

}  // namespace fathom

#pragma once

#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/support/pose_graph/edge.hpp"
#include "estimators/support/pose_graph/picture_states.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/geometry/trajectory.hpp"

/// Covariances from the factor of the Gauss-Newton matrix at an estimate, keyframe 0 fixed; nothing
/// where the matrix is not positive definite, or rounding has left nothing of a pivot, of the rows
/// themselves too (NormalEquations::solve_rows).
namespace fathom::pose_graph {

/// The 3×3 covariance of each keyframe.
std::optional<std::vector<Eigen::Matrix3d>> marginals(std::span<const Edge> edges,
                                                      std::span<const Node> nodes);

/// As of Estimator: a solve for the columns of each keyframe.
std::optional<Eigen::MatrixXd> joint_covariance(std::span<const Edge> edges,
                                                std::span<const Node> nodes,
                                                std::span<const std::size_t> keyframes);

/// As of TrajectoryView.
std::optional<std::vector<UncertainPose>> motions_to_newest(std::span<const Edge> edges,
                                                            std::span<const Node> nodes);

/// As of PredictedCovariances, for loops that end at the newest keyframe.
std::optional<std::vector<Eigen::Matrix3d>> predicted_covariances(
    std::span<const Edge> edges, std::span<const Node> nodes,
    std::span<const RelativePose> forward_loops);

/// The same of loops that share errors with their pictures: of h(x) + G_from n_from + G_to n_to. A
/// picture that the graph does not have is as its prior says.
std::optional<std::vector<Eigen::Matrix3d>> predicted_shared_covariances(
    const ExtendedGraph& graph, std::span<const RelativePose> forward_loops);

}  // namespace fathom::pose_graph

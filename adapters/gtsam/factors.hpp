#pragma once

// GTSAM's names for what Fathom gives it. Tangent vectors of gtsam::Pose2 are in the axes of the
// pose; covariances of Fathom are in those of the world.

#include <gtsam/config.h>
#include <gtsam/geometry/Pose2.h>
#include <gtsam/nonlinear/Marginals.h>
#include <gtsam/nonlinear/NonlinearFactorGraph.h>
#include <gtsam/nonlinear/Values.h>
#include <optional>
#include <span>
#include <vector>

#include "fathom/measurements/relative_pose.hpp"

namespace fathom {

/// GTSAM has no fixed variable that its marginals can do with. So node 0 has a prior of this σ, m
/// and rad, in all directions. At the least F it is met exactly, and what it adds to covariances is
/// taken off again (`without_prior`).
inline constexpr double kPriorSigma = 1e-4;

gtsam::Pose2 to_gtsam(const Pose& pose);
Pose from_gtsam(const gtsam::Pose2& pose);

void add_prior(gtsam::NonlinearFactorGraph& graph, const Pose& node_0);

/// A BetweenFactor. GTSAM builds that class, unless told otherwise, with Jacobians that leave out
/// how the residual turns with its own heading. Then Gauss-Newton ends where those are zero, beside
/// the least F; `exact_jacobians` has them whole. Information that is not positive definite, of an
/// absolute position or a heading alone, has residuals of any size, so its Jacobians are always
/// whole.
void add_edge(gtsam::NonlinearFactorGraph& graph, const RelativePose& z, bool exact_jacobians);

/// LAGO's poses (Carlone et al. 2011): GTSAM has it for diagonal noise, so each edge's is taken to
/// be. Throws what GTSAM throws.
gtsam::Values lago_start(std::span<const RelativePose> edges, const Pose& node_0);

/// The covariance between nodes i and k in world axes given node 0, from theirs in GTSAM's, with
/// the poses at which it was linearised.
Eigen::Matrix3d without_prior(const Eigen::Matrix3d& in_axes_of_poses, const gtsam::Pose2& i,
                              const gtsam::Pose2& k, const gtsam::Pose2& node_0);

/// Of nodes in the order given (Estimate::joint_covariance); nothing where GTSAM throws.
std::optional<Eigen::MatrixXd> joint_of(const gtsam::Marginals& marginals,
                                        const gtsam::Values& poses,
                                        std::span<const std::size_t> nodes);

}  // namespace fathom

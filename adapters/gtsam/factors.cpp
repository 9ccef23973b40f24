#include "adapters/gtsam/factors.hpp"

#include <gtsam/linear/NoiseModel.h>
#include <gtsam/slam/BetweenFactor.h>
#include <gtsam/slam/PriorFactor.h>
#include <gtsam/slam/lago.h>

#include <Eigen/Eigenvalues>

#include "fathom/estimation/joint_covariance.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

#if GTSAM_VERSION_NUMERIC >= 40300
using OptionalJacobian = gtsam::OptionalMatrixType;
#else
using OptionalJacobian = boost::optional<gtsam::Matrix&>;
#endif

/// e = t2v(Z⁻¹ X_i⁻¹ X_k) with the whole of its Jacobians, whatever GTSAM was built with. LAGO
/// knows BetweenFactor alone.
class ExactBetweenFactor final : public gtsam::BetweenFactor<gtsam::Pose2> {
 public:
  using BetweenFactor::BetweenFactor;

  gtsam::NonlinearFactor::shared_ptr clone() const override {
    return gtsam::NonlinearFactor::shared_ptr(new ExactBetweenFactor(*this));
  }

  gtsam::Vector evaluateError(const gtsam::Pose2& X_i, const gtsam::Pose2& X_k,
                              OptionalJacobian e_i, OptionalJacobian e_k) const override {
    gtsam::Matrix3 motion_i;
    gtsam::Matrix3 motion_k;
    const gtsam::Pose2 motion = X_i.between(X_k, motion_i, motion_k);
    const gtsam::Pose2 error = measured().between(motion);
    gtsam::Matrix3 e_motion = gtsam::Matrix3::Identity();
    e_motion.topLeftCorner<2, 2>() = error.rotation().matrix();
    if (e_i) *e_i = e_motion * motion_i;
    if (e_k) *e_k = e_motion * motion_k;
    return gtsam::Vector3(error.x(), error.y(), error.theta());
  }
};

// R with RᵀR = Ω, of any rank.
gtsam::Matrix root_of(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(information);
  return eigen.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         eigen.eigenvectors().transpose();
}

gtsam::SharedNoiseModel noise_of(const Eigen::Matrix3d& information, bool is_definite) {
  return is_definite ? gtsam::noiseModel::Gaussian::Information(information)
                     : gtsam::noiseModel::Gaussian::SqrtInformation(root_of(information), false);
}

gtsam::SharedNoiseModel prior_noise() {
  return gtsam::noiseModel::Diagonal::Sigmas(gtsam::Vector3::Constant(kPriorSigma));
}

Eigen::Matrix3d turned(double theta) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(theta).toRotationMatrix();
  return turn;
}

// How (x, y, θ) of a pose moves with that of node 0 where the whole map moves with it.
Eigen::Matrix3d moved_with(const gtsam::Pose2& node_0, const gtsam::Pose2& pose) {
  Eigen::Matrix3d J = Eigen::Matrix3d::Identity();
  J(0, 2) = -(pose.y() - node_0.y());
  J(1, 2) = pose.x() - node_0.x();
  return J;
}

}  // namespace

gtsam::Pose2 to_gtsam(const Pose& pose) {
  return {pose.x, pose.y, pose.theta};
}

Pose from_gtsam(const gtsam::Pose2& pose) {
  return {pose.x(), pose.y(), wrap_angle(pose.theta())};
}

void add_prior(gtsam::NonlinearFactorGraph& graph, const Pose& node_0) {
  graph.emplace_shared<gtsam::PriorFactor<gtsam::Pose2>>(0, to_gtsam(node_0), prior_noise());
}

void add_edge(gtsam::NonlinearFactorGraph& graph, const RelativePose& z, bool exact_jacobians) {
  const bool is_definite = is_positive_definite(z.information);
  const gtsam::SharedNoiseModel noise = noise_of(z.information, is_definite);
  if (exact_jacobians || !is_definite) {
    graph.emplace_shared<ExactBetweenFactor>(z.from, z.to, to_gtsam(z.motion), noise);
  } else {
    graph.emplace_shared<gtsam::BetweenFactor<gtsam::Pose2>>(z.from, z.to, to_gtsam(z.motion),
                                                             noise);
  }
}

gtsam::Values lago_start(std::span<const RelativePose> edges, const Pose& node_0) {
  gtsam::NonlinearFactorGraph graph;
  add_prior(graph, node_0);
  for (const RelativePose& z : edges) {
    if (!is_positive_definite(z.information)) continue;
    const Eigen::Vector3d variances = z.information.inverse().diagonal();
    graph.emplace_shared<gtsam::BetweenFactor<gtsam::Pose2>>(
        z.from, z.to, to_gtsam(z.motion), gtsam::noiseModel::Diagonal::Variances(variances));
  }
  return gtsam::lago::initialize(graph);
}

Eigen::Matrix3d without_prior(const Eigen::Matrix3d& in_axes_of_poses, const gtsam::Pose2& i,
                              const gtsam::Pose2& k, const gtsam::Pose2& node_0) {
  return turned(i.theta()) * in_axes_of_poses * turned(k.theta()).transpose() -
         kPriorSigma * kPriorSigma * moved_with(node_0, i) * moved_with(node_0, k).transpose();
}

std::optional<Eigen::MatrixXd> joint_of(const gtsam::Marginals& marginals,
                                        const gtsam::Values& poses,
                                        std::span<const std::size_t> nodes) try {
  const std::vector<std::size_t> free = free_keyframes(nodes);
  if (free.empty()) return in_order_of(nodes, {});
  const gtsam::JointMarginal joint =
      marginals.jointMarginalCovariance(gtsam::KeyVector(free.begin(), free.end()));
  const auto pose = [&](std::size_t k) { return poses.at<gtsam::Pose2>(k); };
  const auto m = static_cast<Eigen::Index>(free.size());
  Eigen::MatrixXd all(3 * m, 3 * m);
  for (Eigen::Index i = 0; i < m; ++i) {
    for (Eigen::Index k = 0; k < m; ++k) {
      const std::size_t a = free[static_cast<std::size_t>(i)];
      const std::size_t b = free[static_cast<std::size_t>(k)];
      all.block<3, 3>(3 * i, 3 * k) = without_prior(joint(a, b), pose(a), pose(b), pose(0));
    }
  }
  return in_order_of(nodes, all);
} catch (const std::exception&) {
  return std::nullopt;
}

}  // namespace fathom

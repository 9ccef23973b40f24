#pragma once

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "estimators/trajectory_iekf/stretch.hpp"
#include "fathom/estimation/loop_rows.hpp"
#include "fathom/estimation/shared_error_model.hpp"
#include "fathom/measurements/relative_pose.hpp"

/// The registrations of one update, written forward and stacked, at a stretch of motions.
namespace fathom {

struct StackedLoop {
  StackedLoop(const RelativePose& forward, SharedErrorModel model);

  std::size_t from = 0;
  std::size_t to = 0;  ///< the newest keyframe
  Pose motion;
  LoopRows rows;  ///< with R of its own errors, where those of its pictures are told
  std::shared_ptr<const SharedErrors> shared;  ///< where they are, and are asked for
};

/// Whether an update with this model asks what the registration's pictures share.
bool is_told(const RelativePose& z, SharedErrorModel model);

std::vector<StackedLoop> stacked(std::span<const RelativePose> loops, SharedErrorModel model);
/// The first motion on the way of any of them to the newest keyframe; of so many motions.
std::size_t first_motion(std::span<const StackedLoop> loops, const MotionTree& tree,
                         std::size_t motions);

/// A motion corrected by its part of the state's correction, heading wrapped.
Pose moved(const Pose& motion, const Eigen::Vector3d& delta);

/// The motions from `first` on, corrected by δ.
Stretch stretch_at(const MotionTree& tree, const std::vector<Pose>& motions, std::size_t first,
                   const Eigen::VectorXd& delta);

/// C (z − h(x)), headings wrapped.
Eigen::VectorXd innovations(std::span<const StackedLoop> loops, const Stretch& stretch);

/// H of the loops stacked.
StackedJacobian jacobian(std::span<const StackedLoop> loops, const Stretch& stretch);
PictureJacobian picture_jacobian(std::span<const StackedLoop> loops,
                                 const filter::PictureErrorStates& pictures);

/// ν(x)ᵀ R⁻¹ ν(x).
double misfit(std::span<const StackedLoop> loops, const Eigen::VectorXd& nu);

}  // namespace fathom

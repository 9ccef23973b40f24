// What breaks the clauses on covariances, absolute measurements and holes.

#include "fathom/geometry/covariance.hpp"
#include "tests/estimators/breaches.hpp"

namespace fathom::test {
namespace {

void drop_absolute(std::vector<AbsolutePose>& absolute) {
  absolute.clear();
}

void hold_the_start(EstimatorSetup& setup, EstimatorValues& /*values*/) {
  setup.start = setup.start.pose;
}

void measure_the_hole(RelativePose& step) {
  if (!step.is_hole) return;
  step.is_hole = false;
  step.information = 1e4 * Eigen::Matrix3d::Identity();
}

void measure_a_jump(RelativePose& step) {
  if (step.is_hole) step.motion.x += 100.0;
  measure_the_hole(step);
}

void widen(std::vector<UncertainPose>& motions) {
  for (UncertainPose& motion : motions) motion.covariance *= 1.001;
}

void take_as_independent(EstimatorSetup& /*setup*/, EstimatorValues& values) {
  values["shared_errors"] = OptionValue::scalar("independent");
}

void leave_out_what_is_shared(std::vector<RelativePose>& registrations) {
  for (RelativePose& z : registrations) {
    if (!z.shared) continue;
    z.information =
        RelativePose::from_covariance(z.from, z.to, z.motion, z.shared->own).information;
    z.shared = nullptr;
  }
}

void forget_correlations(std::optional<Eigen::MatrixXd>& joint) {
  for (Eigen::Index i = 0; i < joint->rows(); i += 3) {
    for (Eigen::Index j = 0; j < joint->cols(); j += 3) {
      if (i != j) joint->block<3, 3>(i, j).setZero();
    }
  }
}

}  // namespace

std::vector<Breach> covariance_breaches() {
  return {{"covariances",
           "covariance of keyframe 1 is off by",
           {.covariance = times<Eigen::Matrix3d>(1.0 + 1e-6)}},
          {"joint_covariance",
           "the joint covariance, as a share of both keyframes' own, is off by",
           {.joint = forget_correlations}},
          {"joint_symmetry",
           "the transpose of the joint covariance is off by",
           {.joint = [](auto& joint) { (*joint)(0, 1) *= 1.0 + 1e-12; }}},
          {"marginals",
           "the joint covariance's block of keyframe 13 is off by",
           {.covariance = times<Eigen::Matrix3d>(1.0 + 1e-6)}},
          {"newest_covariance",
           "newest_covariance() of keyframe 1 is off by",
           {.newest_covariance = times<Eigen::Matrix3d>(1.001)}},
          {"fixed_covariance",
           "joint_covariance of keyframe 0 is off by",
           {.joint = [](auto& joint) { joint->diagonal().array() += 1e-9; }}},
          {"motions_to_newest",
           "covariance of the motion to the newest from keyframe 0 is off by",
           {.motions = widen}},
          {"motions_of_steps",
           "the motion to the newest from keyframe 38 is off by",
           {.motions =
                [](auto& motions) {
                  for (UncertainPose& motion : motions) motion.mean = inverse(motion.mean);
                }}},
          {"motion_from_zero",
           "covariance of the motion from keyframe 0 is off by",
           {.motions = widen}},
          {"overridden_defaults",
           "covariance of the motion to the newest from keyframe 0 is off by",
           {.motions = widen}},
          {"shared_errors",
           "covariance of keyframe 1 is off by",
           {.covariance = times<Eigen::Matrix3d>(1.0 + 1e-3)}},
          {"shared_errors",
           "least eigenvalue above the joint covariance, of keyframe 2 -",
           {.setup = take_as_independent, .registrations = leave_out_what_is_shared}},
          {"overridden_defaults",
           "covariance of keyframe 1 is off by",
           {.covariance = times<Eigen::Matrix3d>(1.0 + 1e-6)}}};
}

std::vector<Breach> absolute_breaches() {
  return {{"uncertain_zero", "covariance(0) is off by", {.setup = hold_the_start}},
          {"uncertain_map", "covariance of keyframe 0 is off by", {.setup = hold_the_start}},
          {"exact_absolute",
           "keyframe 0's variance, of that of the start, is",
           {.absolute = drop_absolute}},
          {"without_information",
           "at most 0 allowed",
           {.absolute =
                [](auto& all) {
                  for (AbsolutePose& z : all) z.information += 1e-3 * Eigen::Matrix3d::Identity();
                }}},
          {"linear_case",
           "is off by",
           {.absolute =
                [](auto& all) {
                  for (AbsolutePose& z : all) z.information *= 1.1;
                }}},
          {"nanometre_fixes", "is off by", {.absolute = drop_absolute}},
          {"rotated_absolute",
           "is off by",
           {.absolute =
                [](auto& all) {
                  for (AbsolutePose& z : all) {
                    z.information = transport(planar_rotation(z.pose.theta), z.information);
                  }
                }}},
          {"far_absolute",
           "pose 0 is off by",
           {.pose = [](auto& pose) { pose.y = static_cast<float>(pose.y); }}},
          {"repeatable_absolute", "at most 0 allowed", {.pose = drift}},
          {"gate_refuses_fix",
           "of keyframe 20, which jumps, is used, expected rejected",
           {.setup = ignore_the_gate}},
          {"least_squares_near", "is off by", {.absolute = drop_absolute}},
          {"holes_and_loops", "is off by", {.step = measure_the_hole}},
          {"holes_and_fixes", "is off by", {.step = measure_a_jump}},
          {"holes_in_batch", "is off by", {.step = measure_the_hole}},
          {"free_start", "is off by", {.setup = hold_the_start}}};
}

}  // namespace fathom::test

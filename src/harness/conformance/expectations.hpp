#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/estimation/estimator.hpp"

/// What clauses ask for. Each throws Broken with what was expected and what was found; a NaN meets
/// no expectation.
namespace fathom::conformance {

/// How a clause is broken, one line.
struct Broken : std::runtime_error {
  using std::runtime_error::runtime_error;
};

void expect(bool holds, const std::string& how);
/// "WHAT FOUND UNIT, at most MOST allowed".
void expect_at_most(const std::string& what, double found, double most,
                    const std::string& unit = "");
void expect_at_least(const std::string& what, double found, double least,
                     const std::string& unit = "");

void expect_outcome(const std::string& what, Outcome found, Outcome expected);
/// Converged, or stopped at its iteration limit.
void expect_done(const std::string& what, Outcome found);

/// Positions and headings, both to `most` metres and radians.
void expect_near(const std::string& what, const Pose& found, const Pose& expected, double most);
void expect_poses(const TrajectoryView& found, std::span<const Pose> expected, double most);
void expect_same_bits(const TrajectoryView& found, std::span<const Pose> expected);

/// ‖found − expected‖, as a share of ‖expected‖ and beside a floor for what is zero.
void expect_covariance(const std::string& what, const Eigen::MatrixXd& found,
                       const Eigen::MatrixXd& expected, double share, double floor = 0.0);

/// Poses to `most` metres and radians and covariances to this share: those of an estimate in axes
/// that stand at `world`.
void expect_moved(const Estimate& found, const Estimate& plain, const Pose& world, double most,
                  double share);

/// That there is one, of the right size.
Eigen::Matrix3d covariance_of(const Estimate& estimate, std::size_t k);
Eigen::Matrix3d newest_covariance_of(const Estimate& estimate);
Eigen::MatrixXd joint_of(const Estimate& estimate, const std::vector<std::size_t>& keyframes);
std::vector<UncertainPose> motions_of(const Estimate& estimate);

/// "WHAT 12".
std::string numbered(const std::string& what, std::size_t k);

}  // namespace fathom::conformance

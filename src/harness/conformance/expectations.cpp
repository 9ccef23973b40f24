#include "expectations.hpp"

#include <cmath>
#include <fmt/format.h>

#include "fathom/core/text.hpp"

namespace fathom::conformance {
namespace {

std::string with_unit(double value, const std::string& unit) {
  return short_number(value) + (unit.empty() ? "" : " " + unit);
}

}  // namespace

void expect(bool holds, const std::string& how) {
  if (!holds) throw Broken(how);
}

void expect_at_most(const std::string& what, double found, double most, const std::string& unit) {
  if (found <= most) return;
  throw Broken(
      fmt::format("{} {}, at most {} allowed", what, with_unit(found, unit), short_number(most)));
}

void expect_at_least(const std::string& what, double found, double least, const std::string& unit) {
  if (found >= least) return;
  throw Broken(fmt::format("{} {}, at least {} expected", what, with_unit(found, unit),
                           short_number(least)));
}

void expect_outcome(const std::string& what, Outcome found, Outcome expected) {
  if (found == expected) return;
  throw Broken(what + " ended as " + name_of(found) + ", expected " + name_of(expected));
}

void expect_done(const std::string& what, Outcome found) {
  if (is_done(found)) return;
  throw Broken(what + " ended as " + name_of(found) + ", expected " + name_of(Outcome::converged));
}

void expect_near(const std::string& what, const Pose& found, const Pose& expected, double most) {
  expect_at_most(what + " is off by", (found.position() - expected.position()).norm(), most, "m");
  expect_at_most(what + " is off by", std::abs(wrap_angle(found.theta - expected.theta)), most,
                 "rad");
}

void expect_poses(const TrajectoryView& found, std::span<const Pose> expected, double most) {
  expect(found.size() == expected.size(),
         fmt::format("size() is {}, expected {}", found.size(), expected.size()));
  for (std::size_t k = 0; k < expected.size(); ++k) {
    expect_near(numbered("pose", k), found.pose(k), expected[k], most);
  }
}

void expect_same_bits(const TrajectoryView& found, std::span<const Pose> expected) {
  for (std::size_t k = 0; k < expected.size(); ++k) {
    const Pose pose = found.pose(k);
    if (pose == expected[k]) continue;
    expect_near(numbered("pose", k), pose, expected[k], 0.0);
    throw Broken(numbered("pose", k) + " has a heading that is another by turns");
  }
}

void expect_covariance(const std::string& what, const Eigen::MatrixXd& found,
                       const Eigen::MatrixXd& expected, double share, double floor) {
  const double norm = expected.norm();
  const double difference = (found - expected).norm();
  if (difference <= share * norm + floor) return;
  throw Broken(what + " is off by " + short_number(difference) + " in norm, expected norm " +
               short_number(norm) + ", at most " + short_number(share * norm + floor) + " allowed");
}

Eigen::Matrix3d covariance_of(const Estimate& estimate, std::size_t k) {
  const auto covariance = estimate.covariance(k);
  expect(covariance.has_value(), "covariance(" + std::to_string(k) + ") is nothing");
  return *covariance;
}

Eigen::Matrix3d newest_covariance_of(const Estimate& estimate) {
  const auto covariance = estimate.newest_covariance();
  expect(covariance.has_value(), "newest_covariance() is nothing");
  return *covariance;
}

Eigen::MatrixXd joint_of(const Estimate& estimate, const std::vector<std::size_t>& keyframes) {
  const auto joint = estimate.joint_covariance(keyframes);
  expect(joint.has_value(),
         "joint_covariance of " + std::to_string(keyframes.size()) + " keyframes is nothing");
  return *joint;
}

std::vector<UncertainPose> motions_of(const Estimate& estimate) {
  const auto motions = estimate.motions_to_newest();
  expect(motions.has_value(), "motions_to_newest() is nothing");
  return *motions;
}

std::string numbered(const std::string& what, std::size_t k) {
  return what + " " + std::to_string(k);
}

void expect_moved(const Estimate& found, const Estimate& plain, const Pose& world, double most,
                  double share) {
  for (std::size_t k = 0; k < plain.size(); ++k) {
    expect_near(numbered("pose", k), found.pose(k), compose(world, plain.pose(k)), most);
    expect_covariance(numbered("covariance of keyframe", k), covariance_of(found, k),
                      transport(planar_rotation(world.theta), covariance_of(plain, k)), share,
                      1e-15);
  }
}

}  // namespace fathom::conformance

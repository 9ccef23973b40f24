#include "fathom/estimation/estimator.hpp"

#include <algorithm>
#include <array>

#include "fathom/geometry/covariance.hpp"

namespace fathom {

std::string name_of(Outcome outcome) {
  switch (outcome) {
    case Outcome::converged:
      return "converged";
    case Outcome::iteration_limit:
      return "iteration_limit";
    case Outcome::diverged:
      return "diverged";
    case Outcome::numerical_failure:
      return "numerical_failure";
    case Outcome::crashed:
      return "crashed";
    case Outcome::timed_out:
      return "timed_out";
    case Outcome::out_of_memory:
      break;
  }
  return "out_of_memory";
}

std::string name_of(LoopFate fate) {
  switch (fate) {
    case LoopFate::used:
      return "used";
    case LoopFate::rejected:
      return "rejected";
    case LoopFate::lost:
      break;
  }
  return "lost";
}

Outcome worse(Outcome a, Outcome b) {
  return std::max(a, b);
}

bool is_done(Outcome outcome) {
  return outcome <= Outcome::iteration_limit;
}

std::optional<Eigen::Matrix3d> Estimate::covariance(std::size_t k) const {
  const auto joint = joint_covariance(std::span(&k, 1));
  if (!joint) return std::nullopt;
  return Eigen::Matrix3d(*joint);
}

std::optional<Eigen::Matrix3d> Estimate::newest_covariance() const {
  const std::size_t newest = size() - 1;
  const auto joint = joint_covariance(std::span(&newest, 1));
  if (!joint) return std::nullopt;
  return Eigen::Matrix3d(*joint);
}

std::optional<std::vector<UncertainPose>> Estimate::motions_to_newest() const {
  std::vector<UncertainPose> motions;
  const std::size_t newest = size() - 1;
  for (std::size_t k = 0; k < newest; ++k) {
    const std::array<std::size_t, 2> ends{k, newest};
    const auto joint = joint_covariance(ends);
    if (!joint) return std::nullopt;
    const PairCovariance pair{joint->topLeftCorner<3, 3>(), joint->bottomRightCorner<3, 3>(),
                              joint->topRightCorner<3, 3>()};
    motions.push_back(between(pose(k), pose(newest), pair));
  }
  return motions;
}

}  // namespace fathom

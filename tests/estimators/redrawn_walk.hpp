#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Dense>

#include "tests/measurements/shared_log.hpp"

namespace fathom::test {

/// A SharedWalk with other errors: those of a vector of standard normal numbers, all of them as
/// small as one likes, so that a filter is linear in them; holes in place of some of its steps, and
/// without some of its registrations.
class RedrawnWalk {
 public:
  using Keeps = std::function<bool(std::size_t from, std::size_t to)>;

  RedrawnWalk(
      SharedWalk walk, double size, std::vector<std::size_t> holes = {},
      Keeps keeps = [](std::size_t, std::size_t) { return true; })
      : walk_(std::move(walk)), size_(size), holes_(std::move(holes)), keeps_(std::move(keeps)) {}

  const std::vector<Pose>& truth() const { return walk_.truth; }
  std::size_t keyframes() const { return walk_.truth.size(); }

  /// Numbers that a log takes: three a picture, step and registration.
  Eigen::Index numbers() const {
    std::size_t three = 2 * keyframes() - 1;
    for (std::size_t k = 0; k < keyframes(); ++k)
      three += walk_.log.arrival(k).registrations.size();
    return static_cast<Eigen::Index>(3 * three);
  }

  MeasurementLog log(const Eigen::VectorXd& errors) const {
    MeasurementLog log;
    auto next = static_cast<Eigen::Index>(3 * keyframes());
    const auto drawn = [&](const Eigen::Matrix3d& C) -> Eigen::Vector3d {
      next += 3;
      return C.llt().matrixL() * errors.segment<3>(next - 3);
    };
    for (std::size_t k = 1; k < keyframes(); ++k) {
      const RelativePose& step = walk_.log.arrival(k).step;
      const Eigen::Vector3d error = drawn(step.covariance());
      const bool is_hole = std::ranges::find(holes_, k) != holes_.end();
      log.add_keyframe(is_hole ? hole(k) : measured(step, error, step.covariance()));
      for (const RelativePose& z : walk_.log.arrival(k).registrations) {
        RelativePose small = registration(z, drawn(own(z)), errors);
        if (keeps_(std::min(z.from, z.to), k)) log.add_registration(small);
      }
    }
    return log;
  }

 private:
  static Eigen::Matrix3d own(const RelativePose& z) {
    return z.shared ? z.shared->own : z.covariance();
  }

  static RelativePose hole(std::size_t k) {
    const Eigen::Vector3d variances(1e4, 1e4, 9.0);
    RelativePose step =
        RelativePose::from_covariance(k - 1, k, {-3.0, 2.0, 2.0}, variances.asDiagonal());
    step.is_hole = true;
    return step;
  }

  // Error and covariance in the size of the walk's.
  RelativePose measured(const RelativePose& z, const Eigen::Vector3d& error,
                        const Eigen::Matrix3d& covariance) const {
    const Eigen::Vector3d motion =
        between(walk_.truth[z.from], walk_.truth[z.to]).vector() + size_ * error;
    return RelativePose::from_covariance(
        z.from, z.to, {motion.x(), motion.y(), wrap_angle(motion.z())}, size_ * size_ * covariance);
  }

  RelativePose registration(const RelativePose& z, Eigen::Vector3d error,
                            const Eigen::VectorXd& errors) const {
    if (!z.shared) return measured(z, error, z.covariance());
    const auto n = [&](std::size_t k) -> Eigen::Vector3d {
      return errors.segment<3>(static_cast<Eigen::Index>(3 * k));
    };
    error += z.shared->from.scaled() * n(z.from) + z.shared->to.scaled() * n(z.to);
    RelativePose told = measured(z, error, z.shared->total());
    SharedErrors shared = *z.shared;
    shared.from.sigma *= size_;
    shared.to.sigma *= size_;
    shared.own *= size_ * size_;
    told.shared = std::make_shared<const SharedErrors>(shared);
    return told;
  }

  SharedWalk walk_;
  double size_;
  std::vector<std::size_t> holes_;
  Keeps keeps_;
};

/// Standard normal numbers.
inline Eigen::VectorXd drawn_errors(Eigen::Index numbers, std::uint64_t seed) {
  RandomStream random(seed, "redrawn walk");
  Eigen::VectorXd errors(numbers);
  for (double& e : errors) e = random.normal();
  return errors;
}

}  // namespace fathom::test

#pragma once

#include <cmath>
#include <memory>

#include <Eigen/Cholesky>

#include "fathom/core/random.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"
#include "support/planar.hpp"

namespace fathom::test {

/// A random walk with loops between neighbours of the second degree and beyond, in both directions,
/// all of them with full matrices and most told what they share; headings pass ±π. Errors are drawn
/// as they are told.
class SharedWalk {
 public:
  /// `per_keyframe` registrations at most of each.
  SharedWalk(std::size_t keyframes, int per_keyframe, std::uint64_t seed)
      : random_(seed, "shared walk") {
    truth.push_back({});
    errors_.push_back(draw());
    for (std::size_t k = 1; k < keyframes; ++k) add_keyframe(k, per_keyframe);
  }

  MeasurementLog log;
  std::vector<Pose> truth;

 private:
  Eigen::Vector3d draw() { return {random_.normal(), random_.normal(), random_.normal()}; }

  // N(0, C).
  Eigen::Vector3d draw(const Eigen::Matrix3d& C) { return C.llt().matrixL() * draw(); }

  Eigen::Matrix3d matrix(double scale) {
    Eigen::Matrix3d G;
    for (int i = 0; i < 9; ++i) G(i / 3, i % 3) = scale * random_.normal();
    return G;
  }

  Pose disturbed(const Pose& motion, const Eigen::Vector3d& error) const {
    return {motion.x + error.x(), motion.y + error.y(), wrap_angle(motion.theta + error.z())};
  }

  void add_keyframe(std::size_t k, int per_keyframe) {
    const Pose motion{1.0 + 0.1 * random_.normal(), 0.1 * random_.normal(),
                      0.5 + 0.1 * random_.normal()};
    truth.push_back(compose(truth.back(), motion));
    errors_.push_back(draw());
    const Eigen::Matrix3d C = 1e-4 * random_covariance(random_);
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, disturbed(motion, draw(C)), C));
    for (int i = 0; i < per_keyframe && static_cast<std::size_t>(2 * i) + 2 <= k; ++i) {
      log.add_registration(registration(k - static_cast<std::size_t>(2 * i) - 2, k));
    }
  }

  RelativePose registration(std::size_t from, std::size_t to) {
    if (random_.uniform() < 0.5) std::swap(from, to);
    const bool is_told = random_.uniform() < 0.9;
    SharedErrors shared{{matrix(0.3), sigma_of(from)},
                        {matrix(0.3), sigma_of(to)},
                        1e-5 * random_covariance(random_)};
    Eigen::Vector3d error = draw(shared.own);
    if (is_told) {
      error += shared.from.scaled() * errors_[from] + shared.to.scaled() * errors_[to];
    }
    const Pose z = disturbed(between(truth[from], truth[to]), error);
    if (!is_told) return RelativePose::from_covariance(from, to, z, shared.own);
    RelativePose told = RelativePose::from_covariance(from, to, z, shared.total());
    told.shared = std::make_shared<const SharedErrors>(shared);
    return told;
  }

  static Eigen::Vector3d sigma_of(std::size_t k) {
    const double sigma = 0.02 * (1.0 + static_cast<double>(k % 3));
    return {sigma, 0.5 * sigma, k % 4 == 0 ? 0.0 : sigma};
  }

  RandomStream random_;
  std::vector<Eigen::Vector3d> errors_;  // in σ
};

}  // namespace fathom::test

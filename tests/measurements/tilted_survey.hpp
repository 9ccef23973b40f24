#pragma once

#include <cmath>
#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "fathom/core/random.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/measurement_log.hpp"
#include "fathom/measurements/variance_components.hpp"
#include "support/planar.hpp"

namespace fathom::test {

inline const std::vector<VarianceComponent> kTilt{{VarianceComponent::Part::tilt}};
inline const std::vector<VarianceComponent> kBoth{{VarianceComponent::Part::tilt},
                                                  {VarianceComponent::Part::altitude}};

/// What a survey is drawn with, and what its registrations tell of it.
struct TiltedSurveyOptions {
  std::size_t keyframes = 40;
  double per_keyframe = 1.5;  ///< registrations, at most 8 or so
  double tilt_rad = 0.0;      ///< standard deviations of n as it is drawn
  double altitude_m = 0.0;
  Eigen::Vector3d told{0.0, 0.005, 0.005};  ///< and as told
  double own_scale = 1.0;                   ///< of the own errors that are drawn, times those told
};

/// Lanes over a flat floor, up and down, with pictures of 1.5 m from a level camera 1.5 m above,
/// every 0.4 m, and registrations of pictures whose centres are less than 0.9 m apart. G is the
/// response of a least-squares motion over the points that both pictures have: by tilt about
/// altitude · tilt in position. Steps are good to 2 cm and 5 mrad, registrations on their own to
/// about 0.5 mm and 0.5 mrad.
class TiltedSurvey {
 public:
  TiltedSurvey(const TiltedSurveyOptions& options, std::uint64_t seed)
      : options_(options), random_(seed, "tilted survey") {
    const Eigen::Vector3d sigma(options.altitude_m, options.tilt_rad, options.tilt_rad);
    for (std::size_t k = 0; k < options.keyframes; ++k) {
      truth.push_back(place(k));
      errors.push_back(sigma.cwiseProduct(draw()));
    }
    const std::vector<std::vector<std::size_t>> earlier = pairs();
    for (std::size_t k = 1; k < options.keyframes; ++k) {
      log.add_keyframe(step(k));
      for (const std::size_t i : earlier[k]) log.add_registration(registration(i, k));
    }
  }

  MeasurementLog log;
  std::vector<Pose> truth;
  std::vector<Eigen::Vector3d> errors;  // n of each picture

 private:
  static constexpr std::size_t kPerLane = 8;
  static constexpr double kAltitude = 1.5;
  static constexpr double kHalf = 0.75;  // of a picture

  Eigen::Vector3d draw() { return {random_.normal(), random_.normal(), random_.normal()}; }

  static Pose place(std::size_t k) {
    const std::size_t lane = k / kPerLane;
    const auto along = static_cast<double>(k % kPerLane);
    const bool is_back = lane % 2 == 1;
    return {0.4 * (is_back ? kPerLane - 1.0 - along : along), 0.4 * static_cast<double>(lane),
            is_back ? std::acos(-1.0) : 0.0};
  }

  // By the later keyframe, the earlier ones: so many of those near it, at random.
  std::vector<std::vector<std::size_t>> pairs() {
    std::vector<std::pair<std::size_t, std::size_t>> near;
    for (std::size_t k = 2; k < options_.keyframes; ++k) {
      for (std::size_t i = 0; i + 1 < k; ++i) {
        if ((truth[i].position() - truth[k].position()).norm() < 0.9) near.emplace_back(i, k);
      }
    }
    std::vector<std::vector<std::size_t>> chosen(options_.keyframes);
    auto left =
        static_cast<std::size_t>(options_.per_keyframe * static_cast<double>(options_.keyframes));
    for (; left > 0 && !near.empty(); --left) {
      const std::size_t at = random_.index(near.size());
      chosen[near[at].second].push_back(near[at].first);
      near[at] = near.back();
      near.pop_back();
    }
    return chosen;
  }

  static Pose moved(const Pose& motion, const Eigen::Vector3d& error) {
    return {motion.x + error.x(), motion.y + error.y(), wrap_angle(motion.theta + error.z())};
  }

  RelativePose step(std::size_t k) {
    const Eigen::Vector3d sigma(0.02, 0.02, 0.005);
    const Pose motion = between(truth[k - 1], truth[k]);
    return RelativePose::from_covariance(k - 1, k, moved(motion, sigma.cwiseProduct(draw())),
                                         sigma.cwiseAbs2().asDiagonal());
  }

  // By altitude, roll and pitch, of a point seen at p (docs/conventions.md).
  static Eigen::Matrix<double, 2, 3> derivative(const Eigen::Vector2d& p) {
    const Eigen::Vector2d r = p / kAltitude;
    Eigen::Matrix<double, 2, 3> J;
    J << r.x(), kAltitude * r.x() * r.y(), -kAltitude * (1.0 + r.x() * r.x()),  //
        r.y(), kAltitude * (1.0 + r.y() * r.y()), -kAltitude * r.x() * r.y();
    return J;
  }

  void respond(const Pose& z, SharedErrors& shared) const {
    Eigen::Matrix3d A = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d from = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d to = Eigen::Matrix3d::Zero();
    const Eigen::Matrix2d R = rotation(z.theta);
    for (double x = -0.7; x < kHalf; x += 0.2) {
      for (double y = -0.7; y < kHalf; y += 0.2) {
        const Eigen::Vector2d p(x, y);
        const Eigen::Vector2d q = transform(inverse(z), p);
        if (q.cwiseAbs().maxCoeff() > kHalf) continue;
        const Eigen::Vector2d turned = R * q;
        Eigen::Matrix<double, 2, 3> J;
        J << 1.0, 0.0, -turned.y(), 0.0, 1.0, turned.x();
        A += J.transpose() * J;
        from += J.transpose() * derivative(p);
        to -= J.transpose() * R * derivative(q);
      }
    }
    shared.from.G = A.ldlt().solve(from);
    shared.to.G = A.ldlt().solve(to);
  }

  RelativePose registration(std::size_t from, std::size_t to) {
    if (random_.uniform() < 0.3) std::swap(from, to);
    const Pose motion = between(truth[from], truth[to]);
    SharedErrors shared;
    respond(motion, shared);
    shared.from.sigma = options_.told;
    shared.to.sigma = options_.told;
    shared.own = 1e-7 * random_covariance(random_);
    const Eigen::Matrix3d L = shared.own.llt().matrixL();
    const Eigen::Vector3d error =
        shared.from.G * errors[from] + shared.to.G * errors[to] + options_.own_scale * (L * draw());
    RelativePose z = RelativePose::from_covariance(from, to, moved(motion, error), shared.total());
    z.shared = std::make_shared<const SharedErrors>(shared);
    return z;
  }

  TiltedSurveyOptions options_;
  RandomStream random_;
};

}  // namespace fathom::test

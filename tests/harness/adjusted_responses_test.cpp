#include "fathom/measurements/adjusted_responses.hpp"

#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/recording_facts.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

constexpr double kAltitude = 2.0;
constexpr double kSigma = 0.06;  // of an altitude
constexpr double kOwn = 1e-4;    // of a centre of matches, each picture its own
constexpr double kOwnHeading = 1e-4;

// Three lanes of ten keyframes, registrations of all that are less than 1.5 m apart. Each is the
// difference of two centres of matched points, c_from ⊖ c_to, that are scaled by the altitudes
// measured; so are its responses, as a registration has nothing else.
class Lanes {
 public:
  explicit Lanes(std::uint64_t seed) : random_(seed, "lanes") {
    for (std::size_t k = 0; k < 30; ++k) {
      altitudes_m.push_back(kAltitude + kSigma * random_.normal());
      truth.push_back(place(k));
      if (k == 0) continue;
      const Eigen::Matrix3d C = Eigen::Vector3d(1e-2, 1e-2, 1e-4).asDiagonal();
      const Pose motion = between(truth[k - 1], truth[k]);
      log.add_keyframe(RelativePose::from_covariance(
          k - 1, k, disturbed(motion, {0.1 * random_.normal(), 0.1 * random_.normal(), 0.0}), C));
      for (std::size_t i = 0; i < k; ++i) {
        const Pose z = between(truth[i], truth[k]);
        if (std::hypot(z.x, z.y) < 1.5) log.add_registration(registration(i, k, z));
      }
    }
  }

  // Of the map at these poses, less 1: how much larger than the true one.
  double scale_error(const std::vector<Pose>& poses) const {
    double sum = 0.0;
    double squares = 0.0;
    for (std::size_t k = 0; k < truth.size(); ++k) {
      sum += poses[k].x * truth[k].x + poses[k].y * truth[k].y;
      squares += truth[k].x * truth[k].x + truth[k].y * truth[k].y;
    }
    return sum / squares - 1.0;
  }

  MeasurementLog log;
  std::vector<Pose> truth;
  std::vector<double> altitudes_m;

 private:
  static Pose place(std::size_t k) {
    const std::size_t lane = k / 10;
    const auto along = 0.5 * static_cast<double>(lane % 2 == 0 ? k % 10 : 9 - k % 10);
    return {along, static_cast<double>(lane), lane % 2 == 0 ? 0.0 : 3.14159};
  }

  static Pose disturbed(const Pose& motion, const Eigen::Vector3d& error) {
    return {motion.x + error.x(), motion.y + error.y(), motion.theta + error.z()};
  }

  Eigen::Vector2d measured_centre(const Eigen::Vector2d& true_one, std::size_t k) {
    const Eigen::Vector2d noise(random_.normal(), random_.normal());
    return (true_one + kOwn * noise) * altitudes_m[k] / kAltitude;
  }

  RelativePose registration(std::size_t i, std::size_t k, const Pose& motion) {
    const Eigen::Matrix2d R = rotation(motion.theta);
    const Eigen::Vector2d t(motion.x, motion.y);
    // About half-way, where the pictures overlap.
    const Eigen::Vector2d c = 0.5 * t + 0.1 * Eigen::Vector2d(random_.normal(), random_.normal());
    const Eigen::Vector2d from = measured_centre(c, i);
    const Eigen::Vector2d to = R * measured_centre(R.transpose() * (c - t), k);
    SharedErrors shared;
    shared.from.sigma[0] = shared.to.sigma[0] = kSigma;
    shared.from.G.col(0).head<2>() = from / altitudes_m[i];
    shared.to.G.col(0).head<2>() = -to / altitudes_m[k];
    shared.own = Eigen::Vector3d(2.0 * kOwn * kOwn, 2.0 * kOwn * kOwn, kOwnHeading * kOwnHeading)
                     .asDiagonal();
    const Eigen::Vector2d z = from - to;
    RelativePose told = RelativePose::from_covariance(
        i, k, {z.x(), z.y(), motion.theta + kOwnHeading * random_.normal()}, shared.total());
    told.shared = std::make_shared<const SharedErrors>(shared);
    return told;
  }

  RandomStream random_;
};

std::vector<Pose> optimal_poses(const MeasurementLog& log) {
  const auto optimum = batch_optimum(log, builtin_estimators(), {}, RegistrationErrors::shared);
  return optimum ? optimum->poses : std::vector<Pose>{};
}

struct Mean {
  double mean = 0.0;
  double sigma = 0.0;  // of the mean
};

Mean mean_of(const std::vector<double>& values) {
  const auto n = static_cast<double>(values.size());
  Mean of;
  for (const double value : values) of.mean += value / n;
  for (const double value : values) of.sigma += std::pow(value - of.mean, 2);
  of.sigma = std::sqrt(of.sigma / (n * (n - 1.0)));
  return of;
}

TEST(AdjustedResponses, DoNotShrinkTheMap) {
  std::vector<double> as_measured;
  std::vector<double> as_adjusted;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const Lanes lanes(seed);
    const std::vector<Pose> optimum = optimal_poses(lanes.log);
    ASSERT_EQ(optimum.size(), lanes.truth.size());
    as_measured.push_back(lanes.scale_error(optimum));
    as_adjusted.push_back(lanes.scale_error(
        optimal_poses(with_adjusted_responses(lanes.log, optimum, lanes.altitudes_m))));
  }
  const Mean measured = mean_of(as_measured);
  const Mean adjusted = mean_of(as_adjusted);
  EXPECT_LT(measured.mean, -5.0 * measured.sigma);
  EXPECT_LT(std::abs(adjusted.mean), 2.0 * adjusted.sigma);
}

TEST(AdjustedResponses, SumToTheMotionAtTheOptimum) {
  const Lanes lanes(1);
  const std::vector<Pose> optimum = optimal_poses(lanes.log);
  const std::vector<Eigen::Vector3d> errors = own_errors(lanes.log, optimum);
  const MeasurementLog log = with_adjusted_responses(lanes.log, optimum, lanes.altitudes_m);
  auto error = errors.begin();
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) {
      const Eigen::Vector3d sum = lanes.altitudes_m[z.from] * z.shared->from.G.col(0) +
                                  lanes.altitudes_m[z.to] * z.shared->to.G.col(0);
      const Eigen::Vector2d without = z.motion.position() - error->head<2>();
      EXPECT_LT((sum.head<2>() - without).norm(), 1e-12);
      EXPECT_LT((z.covariance() - z.shared->total()).norm(), 1e-12);
      ++error;
    }
  }
  EXPECT_EQ(error, errors.end());
}

TEST(AdjustedResponses, OfAFalseLoopMoveByTenOfItsOwnSigmas) {
  Lanes lanes(2);
  const std::vector<Pose> optimum = optimal_poses(lanes.log);
  RelativePose wrong = lanes.log.arrival(29).registrations.back();
  wrong.motion.x += 1.0;
  lanes.log.add_registration(wrong);
  const MeasurementLog log = with_adjusted_responses(lanes.log, optimum, lanes.altitudes_m);
  const Eigen::Vector3d moved =
      log.arrival(29).registrations.back().shared->from.G.col(0) - wrong.shared->from.G.col(0);
  EXPECT_GT(moved.norm() * 2.0 * lanes.altitudes_m[wrong.from], 9.0 * kOwn * std::sqrt(2.0));
  EXPECT_LT(moved.norm() * 2.0 * lanes.altitudes_m[wrong.from], 11.0 * kOwn * std::sqrt(2.0));
}

TEST(AdjustedResponses, OfAltitudesWithoutErrorsAreLeftAlone) {
  const Lanes lanes(3);
  MeasurementLog exact(lanes.log.start());
  for (std::size_t k = 0; k < lanes.log.size(); ++k) {
    if (k > 0) exact.add_keyframe(lanes.log.arrival(k).step);
    for (RelativePose z : lanes.log.arrival(k).registrations) {
      SharedErrors shared = *z.shared;
      shared.from.sigma = shared.to.sigma = Eigen::Vector3d(0.0, 0.01, 0.01);
      z.information = shared.total().inverse();
      z.shared = std::make_shared<const SharedErrors>(shared);
      exact.add_registration(z);
    }
  }
  const MeasurementLog log = with_adjusted_responses(exact, lanes.truth, lanes.altitudes_m);
  for (std::size_t k = 0; k < log.size(); ++k) {
    for (std::size_t i = 0; i < log.arrival(k).registrations.size(); ++i) {
      const RelativePose& z = log.arrival(k).registrations[i];
      EXPECT_EQ(*z.shared, *exact.arrival(k).registrations[i].shared);
      EXPECT_EQ(z.information, exact.arrival(k).registrations[i].information);
    }
  }
}

}  // namespace
}  // namespace fathom

// Whether an estimate is as good as it says where registrations have keypoints in common.

#include <cmath>
#include <cstddef>
#include <vector>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/front_end/repeated_keypoints.hpp"
#include "fathom/harness/replay.hpp"
#include "front_end/estimate.hpp"

namespace fathom {
namespace {

constexpr double kOfKeypoint_m = 2e-3;
constexpr double kOfHeading_rad = 1e-5;
constexpr std::size_t kPictures = 24;

// Pictures along a line, each with the keypoints that it sees, measured once. A registration is the
// mean difference of those that two pictures have in common.
class Line {
 public:
  explicit Line(std::uint64_t seed) : random_(seed, "keypoints on a line") {
    for (int i = 0; i < 600; ++i) {
      floor_.emplace_back(random_.uniform(-2.0, 8.0), random_.uniform(-1.0, 1.0));
    }
    for (std::size_t k = 0; k < kPictures; ++k) {
      truth.push_back({0.25 * static_cast<double>(k), 0.0, 0.0});
      seen_.push_back(seen_from(truth.back()));
      if (k == 0) continue;
      const Eigen::Matrix3d C = Eigen::Vector3d(1.0, 1.0, 1e-4).asDiagonal();
      log.add_keyframe(RelativePose::from_covariance(k - 1, k, {0.25, 0.0, 0.0}, C));
      for (std::size_t i = 0; i < k; ++i) register_pair_of(i, k);
    }
  }

  MeasurementLog log;
  std::vector<Pose> truth;

 private:
  struct Seen {
    std::vector<bool> is_seen;
    std::vector<Eigen::Vector2d> points;  // in the picture's axes
  };

  Seen seen_from(const Pose& pose) {
    Seen seen;
    for (const Eigen::Vector2d& point : floor_) {
      const Eigen::Vector2d there = point - pose.position();
      seen.is_seen.push_back(std::abs(there.x()) < 1.0 && std::abs(there.y()) < 1.5);
      seen.points.emplace_back(there +
                               kOfKeypoint_m * Eigen::Vector2d(random_.normal(), random_.normal()));
    }
    return seen;
  }

  void register_pair_of(std::size_t i, std::size_t k) {
    constexpr int kFewest = 30;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    int matches = 0;
    for (std::size_t j = 0; j < floor_.size(); ++j) {
      if (!seen_[i].is_seen[j] || !seen_[k].is_seen[j]) continue;
      sum += seen_[i].points[j] - seen_[k].points[j];
      ++matches;
    }
    if (matches < kFewest) return;
    const Eigen::Vector2d z = sum / matches;
    const double variance = 2.0 * kOfKeypoint_m * kOfKeypoint_m / matches;
    const Eigen::Matrix3d own =
        Eigen::Vector3d(variance, variance, kOfHeading_rad * kOfHeading_rad).asDiagonal();
    RelativePose registration = RelativePose::from_covariance(i, k, {z.x(), z.y(), 0.0}, own);
    registration.inliers = matches;
    log.add_registration(registration);
  }

  RandomStream random_;
  std::vector<Eigen::Vector2d> floor_;
  std::vector<Seen> seen_;
};

// Of the last position, over its two degrees of freedom.
double nees_at_the_end(const MeasurementLog& log, const std::vector<Pose>& truth) {
  ReplayOptions options;
  options.mode = SolveMode::batch;
  const EstimatorEntry& entry = builtin_estimators().find("sparse_gauss_newton");
  const Run run = replay(log, entry, {}, options);
  const Eigen::Vector2d error = run.trajectory.back().position() - truth.back().position();
  const Eigen::Matrix2d P = run.covariances->back().topLeftCorner<2, 2>();
  return 0.5 * error.dot(P.inverse() * error);
}

TEST(RepeatedKeypoints, CountedOnceLeaveAnHonestEstimate) {
  const Camera camera = test::wide_camera();
  const std::vector<Stance> stances(kPictures, Stance(1.0));
  constexpr std::uint64_t kSurveys = 150;
  double independent = 0.0;
  double once = 0.0;
  for (std::uint64_t seed = 0; seed < kSurveys; ++seed) {
    const Line line(seed);
    const std::vector<double> repeats = repeats_of_keypoints(line.log, camera, stances);
    independent += nees_at_the_end(line.log, line.truth) / kSurveys;
    once += nees_at_the_end(count_keypoints_once(line.log, repeats), line.truth) / kSurveys;
  }
  EXPECT_GT(independent, 2.0);
  EXPECT_NEAR(once, 1.0, 0.25);
}

}  // namespace
}  // namespace fathom

// A fix along one axis, turned by next to nothing, tells as little across it: that is no scale for
// all other measurements to begin with.

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/geometry/pose.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

constexpr std::size_t kKeyframes = 40;

RelativePose seen(const std::vector<Pose>& truth, std::size_t from, std::size_t to,
                  double information, RandomStream& random) {
  RelativePose z;
  z.from = from;
  z.to = to;
  const double sigma = std::min(1.0 / std::sqrt(information), 0.02);
  z.motion = test::perturbed(between(truth[from], truth[to]), sigma, sigma, random);
  z.information = information * Eigen::Matrix3d::Identity();
  return z;
}

// Steps of 1e-6 and loops of 1e12, which the solver begins at information cut down.
UpdateReport solved_with_axis_at(double turned_rad) {
  const std::vector<Pose> truth = test::circle(kKeyframes);
  RandomStream random(7, "turned axis");
  MeasurementLog log;
  for (std::size_t k = 1; k < kKeyframes; ++k) {
    log.add_keyframe(seen(truth, k - 1, k, 1e-6, random));
    if (k > 20 && k % 6 == 0) log.add_registration(seen(truth, k - 20, k, 1e12, random));
  }
  log.add_registration(seen(truth, 0, kKeyframes - 1, 1e12, random));
  AbsolutePose fix;
  fix.keyframe = kKeyframes - 1;
  fix.pose = {truth.back().x, truth.back().y, 0.0};
  const Eigen::Vector3d axis(-std::sin(turned_rad), std::cos(turned_rad), 0.0);
  fix.information = 100.0 * axis * axis.transpose();
  log.add_absolute(fix);
  const auto estimator =
      builtin_estimators().find("sparse_gauss_newton").create({log.start(), SolveMode::batch}, {});
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (k > 0) estimator->add_keyframe(log.arrival(k).step);
    test::give(*estimator, log.arrival(k));
  }
  return estimator->finish();
}

TEST(TurnedAxis, IsSolvedAsFastAsAStraightOne) {
  const int straight = solved_with_axis_at(0.0).iterations;
  for (const double turned_rad : {1e-9, 1e-8}) {
    const UpdateReport turned = solved_with_axis_at(turned_rad);
    EXPECT_EQ(turned.outcome, Outcome::converged);
    // One for rounding, which kernels do differently.
    EXPECT_LE(turned.iterations, straight + 1) << turned_rad;
  }
}

}  // namespace
}  // namespace fathom

// The end of a batch and of an incremental solve where it is easily lost: weak steps between stiff
// loops, along which a step that promises nothing is long, and measurements so precise that F is
// known to fewer digits than a step gains.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/measurements/loop_terms.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

struct Shape {
  std::size_t keyframes;
  int loops;
  Eigen::Vector3d step_sigmas;  ///< of (x, y, θ)
  Eigen::Vector3d loop_sigmas;
};

MeasurementLog drawn_log(const Shape& shape, std::uint64_t seed) {
  RandomStream random(seed, "last step");
  std::vector<Pose> truth{{}};
  while (truth.size() < shape.keyframes) {
    truth.push_back(compose(truth.back(), {1.0 + 0.1 * random.normal(), 0.2 * random.normal(),
                                           0.1 + 0.2 * random.normal()}));
  }
  const auto measured = [&](std::size_t from, std::size_t to, const Eigen::Vector3d& sigmas) {
    const Pose error{sigmas(0) * random.normal(), sigmas(1) * random.normal(),
                     sigmas(2) * random.normal()};
    return RelativePose::from_covariance(from, to, compose(between(truth[from], truth[to]), error),
                                         sigmas.cwiseAbs2().asDiagonal());
  };
  std::vector<std::vector<std::size_t>> loops(shape.keyframes);
  for (int i = 0; i < shape.loops; ++i) {
    const auto to =
        static_cast<std::size_t>(random.uniform(2.0, static_cast<double>(shape.keyframes)));
    loops[to].push_back(static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(to - 1))));
  }
  MeasurementLog log;
  for (std::size_t k = 1; k < shape.keyframes; ++k) {
    log.add_keyframe(measured(k - 1, k, shape.step_sigmas));
    for (const std::size_t from : loops[k]) {
      log.add_registration(measured(from, k, shape.loop_sigmas));
    }
  }
  return log;
}

double F_of(const MeasurementLog& log, const std::string& tolerance) {
  const auto estimator =
      builtin_estimators()
          .find("sparse_gauss_newton")
          .create({log.start(), SolveMode::batch}, test::values({{"tolerance", tolerance}}));
  EXPECT_EQ(test::feed(*estimator, log), Outcome::converged);
  return chi2(log, poses_of(*estimator));
}

TEST(LastStep, OfABatchSolveDoesNotRaiseF) {
  const Shape weak_between_stiff{40, 3, {0.05, 0.3, 0.15}, {1e-5, 1e-5, 3e-5}};
  // Of 4000 seeds these lost the most by it, up to 2e-5 of F.
  for (const std::uint64_t seed : {1267U, 1962U, 3074U, 3809U}) {
    SCOPED_TRACE(seed);
    const MeasurementLog log = drawn_log(weak_between_stiff, seed);
    EXPECT_LE(F_of(log, "1e-8") / F_of(log, "1e-12") - 1.0, 1e-7);
  }
}

TEST(LastStep, ThatGainsLessThanTheRoundingOfFIsTaken) {
  const Shape precise{60, 8, {1e-5, 1e-5, 1e-6}, {1e-5, 1e-5, 1e-6}};
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    SCOPED_TRACE(seed);
    const MeasurementLog log = drawn_log(precise, seed);
    const auto estimator = builtin_estimators()
                               .find("sparse_gauss_newton")
                               .create({log.start(), SolveMode::incremental}, {});
    EXPECT_EQ(test::feed(*estimator, log), Outcome::converged);
  }
}

}  // namespace
}  // namespace fathom

// The joint test of one keyframe's registrations, against all subsets, and in the filters.

#include <bit>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "fathom/core/chi_squared.hpp"
#include "fathom/estimation/gate.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

struct Drawn {
  Eigen::VectorXd nu;
  Eigen::MatrixXd S;
};

// Correlated innovations of which some are off by a few sigma.
Drawn draw(std::size_t count, RandomStream& random) {
  const auto rows = static_cast<Eigen::Index>(3 * count);
  Eigen::MatrixXd A(rows, rows + 3);
  for (double& a : A.reshaped()) a = random.normal();
  Drawn drawn{Eigen::VectorXd(rows), A * A.transpose() / static_cast<double>(rows)};
  for (double& v : drawn.nu) v = 1.5 * random.normal();
  return drawn;
}

double naive_nis(const Drawn& drawn, unsigned mask, std::size_t count) {
  std::vector<Eigen::Index> rows;
  for (std::size_t j = 0; j < count; ++j) {
    if ((mask >> j & 1U) == 0) continue;
    for (Eigen::Index r = 0; r < 3; ++r) rows.push_back(static_cast<Eigen::Index>(3 * j) + r);
  }
  if (rows.empty()) return 0.0;
  const Eigen::VectorXd nu = drawn.nu(rows);
  return nu.dot(drawn.S(rows, rows).inverse() * nu);
}

TEST(JointGate, FindsTheBestOfAllSubsets) {
  RandomStream random(5, "joint");
  constexpr double kProbability = 0.95;
  std::size_t partial = 0;
  for (int i = 0; i < 60; ++i) {
    const std::size_t count = 1 + static_cast<std::size_t>(random.index(8));
    const Drawn drawn = draw(count, random);
    unsigned best = 0;
    for (unsigned mask = 1; mask < 1U << count; ++mask) {
      const double nis = naive_nis(drawn, mask, count);
      const int size = std::popcount(mask);
      if (nis > chi_squared_quantile(kProbability, 3.0 * size)) continue;
      const int most = std::popcount(best);
      if (size > most || (size == most && nis < naive_nis(drawn, best, count))) best = mask;
    }
    const std::vector<bool> passed =
        jointly_compatible(drawn.nu, drawn.S, std::vector<bool>(count, true), kProbability);
    for (std::size_t j = 0; j < count; ++j) EXPECT_EQ(passed[j], (best >> j & 1U) != 0) << i;
    if (best != 0 && best + 1 != 1U << count) ++partial;
  }
  EXPECT_GT(partial, 10u);
}

TEST(JointGate, LeavesAloneWhatDidNotPassAlone) {
  RandomStream random(6, "joint");
  Drawn drawn = draw(3, random);
  drawn.nu *= 0.01;
  EXPECT_EQ(jointly_compatible(drawn.nu, drawn.S, {true, false, true}, 0.9),
            (std::vector<bool>{true, false, true}));
}

// More than are searched: independent ones, of which two are far off.
TEST(JointGate, DropsTheWorstOfMany) {
  constexpr std::size_t kCount = 20;
  Drawn drawn{Eigen::VectorXd::Constant(3 * kCount, 0.5),
              Eigen::MatrixXd::Identity(3 * kCount, 3 * kCount)};
  drawn.nu(3 * 4) = 30.0;
  drawn.nu(3 * 11) = -20.0;
  const std::vector<bool> passed =
      jointly_compatible(drawn.nu, drawn.S, std::vector<bool>(kCount, true), 0.99);
  for (std::size_t j = 0; j < kCount; ++j) EXPECT_EQ(passed[j], j != 4 && j != 11) << j;
}

// After a long drift any of three loops may be right, but not all: two agree.
TEST(JointGate, FiltersRefuseWhatContradictsTheOthers) {
  MeasurementLog log;
  const Eigen::Matrix3d step = 0.05 * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d loop = 1e-4 * Eigen::Matrix3d::Identity();
  for (std::size_t k = 1; k <= 40; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, {1.0, 0.0, 0.0}, step));
  }
  log.add_registration(RelativePose::from_covariance(0, 40, {40.5, 0.3, 0.01}, loop));
  log.add_registration(RelativePose::from_covariance(1, 40, {42.0, 0.0, 0.0}, loop));
  log.add_registration(RelativePose::from_covariance(0, 40, {40.5, 0.31, 0.0}, loop));
  log.add_registration(RelativePose::from_covariance(0, 40, {40.51, 0.3, 0.0}, loop));
  for (const char* type : {"ekf", "trajectory_iekf"}) {
    const auto fates = [&](const EstimatorValues& values) {
      const auto estimator = builtin_estimators().find(type).create({}, values);
      std::vector<LoopDecision> loops;
      test::feed(*estimator, log, &loops);
      std::vector<LoopFate> result;
      for (const LoopDecision& decision : loops) result.push_back(decision.fate);
      return result;
    };
    constexpr LoopFate kUsed = LoopFate::used;
    EXPECT_EQ(fates(test::values({{"gate_probability", "0.999"}})),
              (std::vector{kUsed, kUsed, kUsed, kUsed}))
        << type;
    EXPECT_EQ(fates(test::values({{"joint_gate_probability", "0.999"}})),
              (std::vector{kUsed, LoopFate::rejected, kUsed, kUsed}))
        << type;
  }
}

}  // namespace
}  // namespace fathom

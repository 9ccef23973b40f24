// Numbers of an estimator that can be none: a judgement of them would be of nothing.

#include <cmath>
#include <functional>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/harness/guarded_estimator.hpp"
#include "fathom/harness/replay.hpp"
#include "harness/scripted_estimator.hpp"
#include "harness/square_log.hpp"

namespace fathom {
namespace {

using test::Script;
using test::scripted;
using test::square_log;
using ::testing::IsEmpty;

const Eigen::Matrix3d kCorrelated{{2, 1, 0.5}, {1, 3, 0.2}, {0.5, 0.2, 1}};

std::string fault_of(const std::function<void(Script&)>& spoil) {
  Script script;
  spoil(script);
  const auto result = replay(square_log(), scripted(script), {}, {});
  EXPECT_EQ(result.outcome, result.fault.empty() ? Outcome::converged : Outcome::numerical_failure);
  return result.fault;
}

std::string fault_of_covariance(const Eigen::Matrix3d& covariance) {
  return fault_of([&](Script& script) { script.covariances[2] = covariance; });
}

std::string fault_of_weight(double weight) {
  return fault_of([&](Script& script) { script.loop_weights = {1, 0.5, 0, weight}; });
}

std::string fault_of_nis(double nis) {
  return fault_of([&](Script& script) {
    script.spoil_report = [nis](UpdateReport& report) { report.loops[0].nis = nis; };
  });
}

TEST(EstimatorContract, ACovarianceIsSymmetricWithoutNegativeVariances) {
  EXPECT_EQ(fault_of_covariance(kCorrelated.triangularView<Eigen::Upper>()),
            "covariance at keyframe 7: that of keyframe 2 is not symmetric");
  EXPECT_EQ(fault_of_covariance(-kCorrelated),
            "covariance at keyframe 7: that of keyframe 2 has a negative variance");
}

TEST(EstimatorContract, ACovarianceMayBeRounded) {
  Eigen::Matrix3d rounded = kCorrelated;
  rounded(0, 1) *= 1.0 + 1e-5;  // of a filter that subtracts K H P
  EXPECT_THAT(fault_of_covariance(rounded), IsEmpty());
  EXPECT_THAT(fault_of_covariance(Eigen::Vector3d(1.0, 1e-6, -1e-17).asDiagonal()), IsEmpty());
  EXPECT_THAT(fault_of_covariance(-1e-20 * kCorrelated), IsEmpty());
}

TEST(EstimatorContract, SoAreJointCovariances) {
  Script script;
  script.joint_covariances = 1;
  const GuardedEstimator sound(scripted(script), {}, {});
  EXPECT_TRUE(sound.joint_covariance(std::vector<std::size_t>{0}));
  script.joint_covariance_factor = -1.0;
  const GuardedEstimator faulty(scripted(script), {}, {});
  EXPECT_FALSE(faulty.joint_covariance(std::vector<std::size_t>{0}));
  EXPECT_EQ(faulty.fault(), "joint_covariance at keyframe 0: it has a negative variance");
}

TEST(EstimatorContract, ANisIsNotNegative) {
  EXPECT_EQ(fault_of_nis(-2.5),
            "update at keyframe 4: decision 0 on registrations has the NIS -2.5, expected 0 or "
            "more");
  EXPECT_THAT(fault_of_nis(0.0), IsEmpty());
  EXPECT_THAT(fault_of_nis(-1e-12), IsEmpty());
  EXPECT_FALSE(fault_of_nis(-1e-5).empty());
  EXPECT_THAT(fault_of_nis(HUGE_VAL), IsEmpty());
}

TEST(EstimatorContract, AWeightIsFrom0To1) {
  EXPECT_EQ(fault_of_weight(-7), "loop_weights at keyframe 7: a weight is -7, expected 0 to 1");
  EXPECT_EQ(fault_of_weight(1.5), "loop_weights at keyframe 7: a weight is 1.5, expected 0 to 1");
  EXPECT_THAT(fault_of_weight(1.0 + 1.2e-7), IsEmpty());  // of single precision
  EXPECT_THAT(fault_of_weight(-1e-12), IsEmpty());
  EXPECT_FALSE(fault_of_weight(-1e-5).empty());
}

}  // namespace
}  // namespace fathom

#include "fathom/front_end/estimated_sigmas.hpp"

#include <cmath>
#include <optional>

#include <gtest/gtest.h>

namespace fathom {
namespace {

const Eigen::Vector3d kAssumed{0.0, 0.005, 0.005};

PairRegistration registered() {
  PairRegistration found;
  found.found = true;
  found.shared.from = {Eigen::Matrix3d::Identity(), kAssumed};
  found.shared.to = {2.0 * Eigen::Matrix3d::Identity(), kAssumed};
  found.shared.own = 4e-4 * Eigen::Matrix3d::Identity();
  found.own.by_told = {16e-4 * Eigen::Matrix3d::Identity(), 9e-4 * Eigen::Matrix3d::Identity(),
                       found.shared.own, 1e-4 * Eigen::Matrix3d::Identity()};
  found.covariance = found.shared.total();
  return found;
}

TEST(EstimatedSigmas, NoneLeaveARegistrationAsItIs) {
  EXPECT_EQ(EstimatedSigmas{}.told(registered(), {}, {}), registered());
}

TEST(EstimatedSigmas, StandForWhatNoSensorStates) {
  MeasuredFrame from, to;
  to.altitude_sigma_m = 0.01;
  from.tilt = MeasuredTilt{};
  const EstimatedSigmas sigmas{0.1, 0.03, std::nullopt};
  const PairRegistration told = sigmas.told(registered(), from, to);
  EXPECT_EQ(told.shared.from.sigma, Eigen::Vector3d(0.1, 0.005, 0.005));
  EXPECT_EQ(told.shared.to.sigma, Eigen::Vector3d(0.0, 0.03, 0.03));
  EXPECT_EQ(told.covariance, told.shared.total());
}

// What altitude and tilt do to the matches is the registration's own unless they are told. One that
// is found to be 0 is not; tilts are assumed.
TEST(EstimatedSigmas, WhatIsToldIsNoErrorOfItsOwn) {
  const auto own = [](const EstimatedSigmas& sigmas) {
    return sigmas.told(registered(), {}, {}).shared.own(0, 0);
  };
  EXPECT_EQ(own({std::nullopt, 0.03, std::nullopt}), 4e-4);
  EXPECT_EQ(own({0.1, std::nullopt, std::nullopt}), 1e-4);
  EXPECT_EQ(own({0.0, 0.03, std::nullopt}), 4e-4);
  EXPECT_EQ(own({0.1, 0.0, std::nullopt}), 9e-4);
  EXPECT_EQ(own({0.0, 0.0, std::nullopt}), 16e-4);
  EXPECT_NEAR(own({std::nullopt, std::nullopt, 3.0}), 36e-4, 1e-15);
  EXPECT_NEAR(own({0.1, std::nullopt, 3.0}), 9e-4, 1e-15);
}

// With the fourth power of what is told of the tilts.
TEST(EstimatedSigmas, TiltsBendAMotion) {
  PairRegistration found = registered();
  found.own.bend_from = 10.0 * Eigen::Matrix3d::Identity();
  found.own.bend_to = 20.0 * Eigen::Matrix3d::Identity();
  MeasuredFrame measured;
  measured.tilt = MeasuredTilt{};
  const auto own = [&](const EstimatedSigmas& sigmas, const MeasuredFrame& to) {
    return sigmas.told(found, {}, to).shared.own(1, 1);
  };
  EXPECT_NEAR(own({std::nullopt, 0.1, std::nullopt}, {}), 4e-4 + 30e-4, 1e-15);
  EXPECT_NEAR(own({std::nullopt, 0.1, std::nullopt}, measured),
              4e-4 + 10e-4 + 20.0 * std::pow(0.005, 4), 1e-15);
  EXPECT_NEAR(own({std::nullopt, 0.1, 2.0}, {}), 4.0 * 34e-4, 1e-15);
  EXPECT_EQ(own({std::nullopt, 0.0, std::nullopt}, {}), 16e-4);
}

}  // namespace
}  // namespace fathom

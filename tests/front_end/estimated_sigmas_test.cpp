#include "fathom/front_end/estimated_sigmas.hpp"

#include <optional>

#include <gtest/gtest.h>

namespace fathom {
namespace {

const Eigen::Vector3d kAssumed{0.01, 0.005, 0.005};

PairRegistration registered() {
  PairRegistration found;
  found.found = true;
  found.shared.from = {Eigen::Matrix3d::Identity(), kAssumed};
  found.shared.to = {2.0 * Eigen::Matrix3d::Identity(), kAssumed};
  found.shared.own = 4e-4 * Eigen::Matrix3d::Identity();
  found.own_beside_altitude = 1e-4 * Eigen::Matrix3d::Identity();
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
  EXPECT_EQ(told.shared.to.sigma, Eigen::Vector3d(0.01, 0.03, 0.03));
  EXPECT_EQ(told.covariance, told.shared.total());
}

// What an altitude does to the matches is the registration's own unless it is told.
TEST(EstimatedSigmas, AnAltitudeThatIsToldIsNoErrorOfItsOwn) {
  const auto own = [](const EstimatedSigmas& sigmas) {
    return sigmas.told(registered(), {}, {}).shared.own(0, 0);
  };
  EXPECT_EQ(own({std::nullopt, 0.03, std::nullopt}), 4e-4);
  EXPECT_EQ(own({0.1, std::nullopt, std::nullopt}), 1e-4);
  EXPECT_NEAR(own({std::nullopt, std::nullopt, 3.0}), 36e-4, 1e-15);
  EXPECT_NEAR(own({0.1, std::nullopt, 3.0}), 9e-4, 1e-15);
}

}  // namespace
}  // namespace fathom

#include "fathom/datasets/motion_noise.hpp"

#include <cmath>

#include <Eigen/LU>
#include <gtest/gtest.h>

#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;

TEST(MotionNoise, HasTheCovarianceAskedFor) {
  OdometryOptions options;
  options.covariance = {4.0, 1.0, -0.5, 2.0, 0.3, 1.0};
  const Eigen::Matrix3d C = options.noise_covariance("");
  EXPECT_EQ(C(0, 1), 1.0);
  EXPECT_EQ(C(2, 0), -0.5);
  EXPECT_EQ(C(1, 2), 0.3);
  const MotionNoise noise(C);
  RandomStream stream(5);
  constexpr int kDraws = 20'000;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
  double chi2 = 0.0;
  for (int i = 0; i < kDraws; ++i) {
    const Eigen::Vector3d e = noise.draw(stream);
    sum += e;
    squares += e * e.transpose();
    chi2 += e.dot(C.inverse() * e);
  }
  // Each within four standard deviations of its estimate.
  EXPECT_LT((sum / kDraws).cwiseQuotient(C.diagonal().cwiseSqrt()).norm(), 7.0 / std::sqrt(kDraws));
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      const double deviation = std::sqrt((C(i, i) * C(j, j) + C(i, j) * C(i, j)) / kDraws);
      EXPECT_NEAR(squares(i, j) / kDraws, C(i, j), 4 * deviation) << i << ' ' << j;
    }
  }
  EXPECT_NEAR(chi2, 3.0 * kDraws, 4 * std::sqrt(6.0 * kDraws));
}

TEST(MotionNoise, OfZeroCovarianceIsZero) {
  RandomStream stream(1);
  EXPECT_EQ(MotionNoise(Eigen::Matrix3d::Zero()).draw(stream), Eigen::Vector3d::Zero().eval());
}

TEST(MotionNoise, SigmasAreSquared) {
  OdometryOptions options;
  options.sigma_x_m = 0.1;
  options.sigma_y_m = 0.2;
  options.sigma_theta_rad = 0.3;
  const Eigen::Matrix3d C = options.noise_covariance("");
  EXPECT_TRUE(C.isApprox(Eigen::Vector3d(0.01, 0.04, 0.09).asDiagonal().toDenseMatrix(), 1e-15));
}

TEST(MotionNoise, SingularCovarianceNamesItsKey) {
  const auto message = [](auto spoil) {
    OdometryOptions options;
    spoil(options);
    return input_error_of([&] { options.noise_covariance("o."); });
  };
  const auto opens = [](const std::string& text, const std::string& with) {
    return text.find(with) == 0;
  };
  EXPECT_TRUE(opens(message([](auto& o) { o.sigma_x_m = 0; }), "o.sigma_x_m: "));
  EXPECT_TRUE(opens(message([](auto& o) { o.sigma_y_m = 0; }), "o.sigma_y_m: "));
  EXPECT_TRUE(opens(message([](auto& o) { o.sigma_theta_rad = 0; }), "o.sigma_theta_rad: "));
  EXPECT_TRUE(opens(message([](auto& o) { o.sigma_y_m = std::nan(""); }), "o.sigma_y_m: "));
  // Correlation of one, and beyond.
  EXPECT_TRUE(opens(message([](auto& o) { o.covariance = {1, 1, 0, 1, 0, 1}; }), "o.covariance: "));
  EXPECT_TRUE(opens(message([](auto& o) { o.covariance = {1, 2, 0, 1, 0, 1}; }), "o.covariance: "));
  EXPECT_TRUE(opens(message([](auto& o) { o.covariance = {0, 0, 0, 0, 0, 0}; }), "o.covariance: "));
  EXPECT_TRUE(opens(message([](auto& o) {
                      o.covariance = {1, 0, 0};
                    }),
                    "o.covariance: expected six"));
}

TEST(MotionNoise, VisualOdometryMayGoWithout) {
  OdometryOptions options;
  options.source = OdometrySource::kVisualOdometry;
  options.covariance = {0, 0, 0, 0, 0, 0};
  EXPECT_TRUE(options.noise_covariance("").isZero(0.0));
  options.covariance = {1, 0, 0, 0, 0, 1};
  EXPECT_NE(input_error_of([&] { options.noise_covariance("o."); }), "(nothing thrown)");
}

}  // namespace
}  // namespace fathom

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

TEST(GaussMarkovNoise, HasCovarianceAndCorrelationOfTheClosedForm) {
  Eigen::Matrix3d C;
  C << 4.0, 1.0, -0.5, 1.0, 2.0, 0.3, -0.5, 0.3, 1.0;
  constexpr double kLength_m = 2.0;
  // Steps of unequal length, each process from its own start.
  const std::vector<double> ways_m{0.7, 0.0, 1.9, 0.4};
  constexpr int kDraws = 20'000;
  RandomStream stream(7);
  std::vector<Eigen::Matrix3d> moments(ways_m.size() + 1, Eigen::Matrix3d::Zero());
  for (int i = 0; i < kDraws; ++i) {
    GaussMarkovNoise noise(C, kLength_m);
    const Eigen::Vector3d first = noise.draw(0.3, stream);
    moments[0] += first * first.transpose();
    for (std::size_t j = 0; j < ways_m.size(); ++j) {
      moments[j + 1] += first * noise.draw(ways_m[j], stream).transpose();
    }
  }
  double way_m = 0.0;
  for (std::size_t j = 0; j < moments.size(); ++j) {
    if (j > 0) way_m += ways_m[j - 1];
    const Eigen::Matrix3d expected = std::exp(-way_m / kLength_m) * C;
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        // Isserlis: the variance of a product of two normal values; four standard deviations.
        const double variance = C(r, r) * C(c, c) + expected(r, c) * expected(r, c);
        EXPECT_NEAR(moments[j](r, c) / kDraws, expected(r, c), 4 * std::sqrt(variance / kDraws))
            << j << ' ' << r << ' ' << c;
      }
    }
  }
}

TEST(GaussMarkovNoise, StaysStationary) {
  GaussMarkovNoise noise(Eigen::Matrix3d::Identity(), 1.0);
  RandomStream stream(3);
  constexpr int kDraws = 40'000;
  double squares = 0.0;
  double products = 0.0;
  double last = noise.draw(0.0, stream).x();
  for (int i = 0; i < kDraws; ++i) {
    const double next = noise.draw(0.5, stream).x();
    squares += next * next;
    products += last * next;
    last = next;
  }
  // Correlated draws: fewer count, (1 − ρ²)/(1 + ρ²) of them, and ρ² of a variance is kept.
  const double kept = std::exp(-0.5);
  const double deviation = std::sqrt(2.0 * (1 + kept * kept) / (1 - kept * kept) / kDraws);
  EXPECT_NEAR(squares / kDraws, 1.0, 4 * deviation);
  EXPECT_NEAR(products / kDraws, kept, 4 * deviation);
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

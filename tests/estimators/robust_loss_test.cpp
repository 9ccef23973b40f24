// The losses: their derivatives against differences, their scales, their values by hand.

#include "fathom/estimation/robust_loss.hpp"

#include <cmath>

#include <gtest/gtest.h>

#include "fathom/core/chi_squared.hpp"
#include "tests/support/input_error.hpp"

namespace fathom {
namespace {

const std::vector<LossKind> kSmooth{LossKind::none, LossKind::huber, LossKind::cauchy,
                                    LossKind::geman_mcclure, LossKind::dcs};

TEST(RobustLoss, DerivativesAreThoseOfTheLoss) {
  for (const LossKind kind : kSmooth) {
    const RobustLoss loss(kind, 1.7);
    for (const double s : {0.01, 1.0, 2.5, 4.0, 30.0, 1e3}) {
      const double h = 1e-5 * s;
      const double slope = (loss.at(s + h).rho - loss.at(s - h).rho) / (2.0 * h);
      const double bend = (loss.at(s + h).weight - loss.at(s - h).weight) / (2.0 * h);
      EXPECT_NEAR(loss.at(s).weight, slope, 1e-6 * (1e-3 + std::abs(slope))) << s;
      EXPECT_NEAR(loss.at(s).curvature, bend, 1e-6 * (1e-3 + std::abs(bend))) << s;
    }
  }
}

TEST(RobustLoss, IsContinuousWhereItSetsIn) {
  for (const LossKind kind : {LossKind::huber, LossKind::dcs, LossKind::truncated}) {
    const RobustLoss loss(kind, 2.0);
    EXPECT_NEAR(loss.at(4.0).rho, loss.at(4.0 + 1e-9).rho, 1e-8);
    EXPECT_DOUBLE_EQ(loss.at(3.9).rho, 3.9);
  }
}

// With c² = 4 and s = 12, by hand.
TEST(RobustLoss, ValuesByHand) {
  EXPECT_NEAR(RobustLoss(LossKind::huber, 2.0).at(12.0).rho, 4.0 * std::sqrt(12.0) - 4.0, 1e-12);
  EXPECT_NEAR(RobustLoss(LossKind::cauchy, 2.0).at(12.0).rho, 4.0 * std::log(4.0), 1e-12);
  EXPECT_NEAR(RobustLoss(LossKind::geman_mcclure, 2.0).at(12.0).rho, 3.0, 1e-12);
  EXPECT_NEAR(RobustLoss(LossKind::geman_mcclure, 2.0).at(12.0).weight, 0.0625, 1e-12);
  // Agarwal's factor 2 Φ / (Φ + χ²) is 1/2, which goes in squared.
  EXPECT_NEAR(RobustLoss(LossKind::dcs, 2.0).at(12.0).weight, 0.25, 1e-12);
  EXPECT_NEAR(RobustLoss(LossKind::dcs, 2.0).at(12.0).rho, 8.0, 1e-12);
  EXPECT_EQ(RobustLoss(LossKind::truncated, 2.0).at(12.0).rho, 4.0);
  EXPECT_EQ(RobustLoss(LossKind::truncated, 2.0).at(12.0).weight, 0.0);
}

TEST(RobustLoss, TheDefaultScaleHalvesTheWeightAtTheQuantile) {
  const double s = chi_squared_quantile(0.99, 3.0);
  for (const LossKind kind :
       {LossKind::huber, LossKind::cauchy, LossKind::geman_mcclure, LossKind::dcs}) {
    EXPECT_NEAR(RobustLoss(LossOptions{kind, std::nullopt}).weight(s), 0.5, 1e-9);
  }
  EXPECT_NEAR(RobustLoss(LossOptions{LossKind::geman_mcclure, 2.0}).squared_scale(), 4.0, 1e-12);
}

TEST(RobustLoss, GraduationWidensTheScale) {
  const RobustLoss loss = RobustLoss(LossKind::geman_mcclure, 2.0).widened(9.0);
  EXPECT_NEAR(loss.at(12.0).rho, RobustLoss(LossKind::geman_mcclure, 6.0).at(12.0).rho, 1e-12);
}

TEST(RobustLoss, AScaleWithoutALossIsRefused) {
  EXPECT_THROW((LossOptions{LossKind::none, 2.0}.check()), InputError);
  EXPECT_NO_THROW((LossOptions{LossKind::huber, 2.0}.check()));
}

}  // namespace
}  // namespace fathom

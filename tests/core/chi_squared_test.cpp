#include "fathom/core/chi_squared.hpp"

#include <cmath>

#include <gtest/gtest.h>

namespace fathom {
namespace {

// mpmath 1.3 with 40 digits: gammainc(k/2, 0, x/2, regularized=True); the last one by quadrature of
// the density.
TEST(ChiSquaredCdf, RecordedNumbers) {
  struct Row {
    double x;
    double degrees_of_freedom;
    double probability;
  };
  for (const auto& [x, dof, probability] : {
           Row{0.5, 1, 0.52049987781304654},
           Row{1, 1, 0.6826894921370859},
           Row{10, 1, 0.99843459774199745},
           Row{0.01, 2, 0.0049875208073176866},
           Row{4, 2, 0.86466471676338731},
           Row{1e-6, 3, 2.6596144047917995e-10},
           Row{30, 3, 0.99999861994296871},
           Row{50, 3, 0.99999999992010821},
           Row{5, 6, 0.45618688411667048},
           Row{70, 100, 0.0098455024764085416},
           Row{100, 100, 0.51880831547204328},
           Row{130, 100, 0.97648760219019132},
           Row{30500, 30000, 0.97896000024091295},
       }) {
    EXPECT_NEAR(chi_squared_cdf(x, dof), probability, 1e-10 * probability) << x << ", " << dof;
  }
}

// As printed in every table of the distribution, to the 17 digits of mpmath 1.3 (bisection).
TEST(ChiSquaredQuantile, RecordedNumbers) {
  struct Row {
    double probability;
    double degrees_of_freedom;
    double x;
  };
  for (const auto& [probability, dof, x] : {
           Row{0.95, 1, 3.841458820694126},
           Row{0.95, 2, 5.991464547107982},
           Row{0.95, 3, 7.81472790325118},
           Row{0.99, 3, 11.344866730144372},
           Row{0.999, 3, 16.266236196238131},
           Row{0.999999, 3, 30.664849706213599},
           Row{0.5, 3, 2.3659738843753383},
           Row{0.025, 3, 0.21579528262389787},
           Row{0.001, 3, 0.024297585815692733},
           Row{1e-6, 3, 0.00024181048720124283},
           Row{0.025, 150, 117.9845154029029},
           Row{0.975, 150, 185.80044700379326},
           Row{0.025, 30000, 29521.805937252692},
           Row{0.975, 30000, 30481.982656347922},
       }) {
    EXPECT_NEAR(chi_squared_quantile(probability, dof), x, 1e-10 * x) << probability << ", " << dof;
  }
}

TEST(ChiSquared, ClosedFormOfTwoDegreesOfFreedom) {
  for (double x = 0.01; x < 60; x *= 1.3) {
    EXPECT_NEAR(chi_squared_cdf(x, 2), -std::expm1(-x / 2), 1e-14);
  }
  for (const double p : {1e-9, 0.1, 0.5, 0.9, 0.999999999}) {
    EXPECT_NEAR(chi_squared_quantile(p, 2), -2 * std::log1p(-p), 1e-6 * -2 * std::log1p(-p));
  }
}

TEST(ChiSquared, CdfRisesAcrossTheJoinOfSeriesAndFraction) {
  for (const double dof : {1.0, 3.0, 7.5, 300.0}) {
    double before = 0.0;
    for (double x = 0.9 * (dof + 2); x < 1.1 * (dof + 2); x += 0.001 * (dof + 2)) {
      const double now = chi_squared_cdf(x, dof);
      EXPECT_GT(now, before) << x << ", " << dof;
      before = now;
    }
  }
}

TEST(ChiSquared, EndsOfTheLine) {
  EXPECT_EQ(chi_squared_cdf(0, 3), 0.0);
  EXPECT_EQ(chi_squared_cdf(-1, 3), 0.0);
  EXPECT_EQ(chi_squared_cdf(1e6, 3), 1.0);
  EXPECT_TRUE(std::isnan(chi_squared_cdf(std::nan(""), 3)));
}

}  // namespace
}  // namespace fathom

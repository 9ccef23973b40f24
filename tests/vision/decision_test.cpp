// When a motion counts as found: the chance of it, rivals, and what is said of a refusal.

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Dense>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/vision/registration.hpp"
#include "vision/labelled.hpp"
#include "vision/points.hpp"

namespace fathom {
namespace {

using test::kTrueMotion;
using test::labelled;
using test::Points;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::MatchesRegex;
using ::testing::StartsWith;

Eigen::Vector2d in_picture(RandomStream& random) {
  const double x = random.uniform(-1.3, 1.3);
  return {x, random.uniform(-1.0, 1.0)};
}

struct Seen {
  Points p, q;

  Registration registered(const RegistrationOptions& options, std::uint64_t seed = 1) const {
    return register_pair(labelled(p), labelled(q), options, seed);
  }
};

// `right` matches of a motion, errors of 2 mm, and `wrong` ones.
Seen some_right(int right, int wrong, std::uint64_t seed) {
  RandomStream random(seed);
  Seen seen;
  for (int i = 0; i < right + wrong; ++i) {
    seen.q.push_back(in_picture(random));
    const double dx = 0.002 * random.normal();
    const double dy = 0.002 * random.normal();
    seen.p.push_back(i < right ? transform(kTrueMotion, seen.q.back()) + Eigen::Vector2d(dx, dy)
                               : in_picture(random));
  }
  return seen;
}

// Nothing but the chance of a motion decides.
RegistrationOptions by_chance_alone() {
  RegistrationOptions options;
  options.ransac.min_inliers = 3;
  options.ransac.min_places = 1;
  options.ransac.iterations = 200;
  return options;
}

// P(X ≥ count) of a Poisson variable, term by term from the top, where all are of one size.
double poisson_tail(int count, double mean) {
  double sum = 0.0;
  for (int k = count; k < count + 400; ++k) {
    sum += std::exp(k * std::log(mean) - mean - std::lgamma(k + 1.0));
  }
  return sum;
}

TEST(FalseAlarms, AreThePoissonTailOfTheRivalsPlaces) {
  for (const int right : {4, 8, 16, 40}) {
    for (const int wrong : {0, 30, 200}) {
      const Evidence evidence = some_right(right, wrong, 3).registered(by_chance_alone()).evidence;
      ASSERT_GE(evidence.rival_places, 2);
      ASSERT_GE(evidence.places, 2);
      const double expected = poisson_tail(evidence.places, evidence.rival_places);
      EXPECT_NEAR(evidence.false_alarms / expected, 1.0, 1e-6) << right << " " << wrong;
    }
  }
}

TEST(FalseAlarms, FallWithEveryMatchThatAgrees) {
  double before = 1.0;
  for (const int right : {4, 8, 16, 32, 64}) {
    const Registration result = some_right(right, 100, 4).registered(by_chance_alone());
    EXPECT_LT(result.evidence.false_alarms, before) << right;
    before = result.evidence.false_alarms;
    EXPECT_EQ(result.found, before <= DecisionOptions{}.max_false_alarms);
  }
}

TEST(FalseAlarms, TheLimitDecides) {
  const Seen seen = some_right(14, 100, 5);
  RegistrationOptions options = by_chance_alone();
  const double chance = seen.registered(options).evidence.false_alarms;
  ASSERT_GT(chance, 0.0);
  options.decision.max_false_alarms = 1.01 * chance;
  EXPECT_TRUE(seen.registered(options).found);
  options.decision.max_false_alarms = 0.99 * chance;
  EXPECT_FALSE(seen.registered(options).found);
}

TEST(Decision, RandomMatchesGiveNoMotion) {
  RegistrationOptions options = by_chance_alone();
  options.ransac.iterations = 100;
  options.ransac.max_error_m = 0.08;
  int most = 0;
  for (std::uint64_t seed = 0; seed < 2000; ++seed) {
    const Registration result = some_right(0, 120, seed).registered(options, seed);
    EXPECT_FALSE(result.found) << seed << ": " << result.evidence.false_alarms;
    most = std::max(most, result.evidence.support);
  }
  // There was something to refuse.
  EXPECT_GE(most, 6);
}

// A square lattice, each point of which is taken for its own image or that of a neighbour.
Seen lattice() {
  RandomStream random(6);
  constexpr double kSpacingM = 0.12;
  Seen seen;
  for (int i = 0; i < 400; ++i) {
    const Eigen::Vector2d q = kSpacingM * Eigen::Vector2d(i % 20 - 10, i / 20 - 10);
    const auto column = static_cast<double>(random.index(3));
    const Eigen::Vector2d shift = kSpacingM * Eigen::Vector2d(column, double(random.index(3)));
    seen.q.push_back(q);
    seen.p.push_back(transform(kTrueMotion, q + shift));
  }
  return seen;
}

TEST(Decision, ALatticeIsRefusedHoweverManyAgree) {
  RegistrationOptions options;
  const Registration refused = lattice().registered(options);
  EXPECT_FALSE(refused.found);
  EXPECT_GE(refused.evidence.support, 40);
  EXPECT_GE(refused.evidence.places, 40);
  EXPECT_GE(refused.evidence.rival_places, 30);
  EXPECT_THAT(refused.reason, HasSubstr("another motion has"));
  EXPECT_GE(static_cast<int>(refused.inliers.size()), refused.evidence.support);  // to be shown
  // Enough agree, if that is all that is asked.
  options.decision.method = DecisionOptions::Method::inliers;
  EXPECT_TRUE(lattice().registered(options).found);
}

TEST(Decision, SaysWhatIsWanting) {
  RegistrationOptions options;
  EXPECT_EQ(Seen{}.registered(options).reason, "0 matches, 12 are needed");
  EXPECT_THAT(some_right(8, 40, 7).registered(options).reason,
              MatchesRegex("(8|9|10|11) matches agree, 12 are needed"));
  options.ransac.min_places = 60;
  EXPECT_THAT(some_right(50, 40, 7).registered(options).reason,
              MatchesRegex("5[0-9] matches agree, in [345][0-9] places, 60 are needed"));
  options = by_chance_alone();
  options.decision.max_false_alarms = 1e-90;
  EXPECT_THAT(some_right(30, 40, 7).registered(options).reason,
              AllOf(StartsWith("30 matches agree, in "), HasSubstr("places; another motion has "),
                    HasSubstr(": by chance "), HasSubstr(", above 1e-90")));
}

TEST(Decision, ByInliersSaysWhatIsWanting) {
  RegistrationOptions options;
  options.decision.method = DecisionOptions::Method::inliers;
  EXPECT_EQ(some_right(9, 2, 8).registered(options).reason, "11 matches, 12 are needed");
  EXPECT_THAT(some_right(8, 40, 8).registered(options).reason,
              MatchesRegex("(8|9|10|11) of 48 matches agree, 12 are needed"));
}

TEST(ScaleCheck, TellsTheRatioOfAltitudesAndLeavesTheMotion) {
  Seen seen = some_right(200, 0, 9);
  // As an altitude of `from` that is 1 % too low would have it, about the camera.
  for (Eigen::Vector2d& p : seen.p) p *= 0.99;
  const Registration result = seen.registered({});
  ASSERT_TRUE(result.found) << result.reason;
  EXPECT_NEAR(result.evidence.scale, 0.99, 4.0 * result.evidence.scale_sigma);
  // 2 mm over √(200 · (1.3² + 1²) / 3) m, more where what the scale explains counts as an error.
  EXPECT_GT(result.evidence.scale_sigma, 0.0001);
  EXPECT_LT(4.0 * result.evidence.scale_sigma, 0.01);
  EXPECT_NEAR(result.motion.theta, kTrueMotion.theta, 0.001);
}

// The same match again, but for its keypoint's size or orientation in `to`.
TEST(Decision, KeypointsOfAnotherSizeOrTurnBearNoWitness) {
  const Seen seen = some_right(60, 0, 11);
  FloorFeatures from = labelled(seen.p);
  FloorFeatures to = labelled(seen.q);
  for (std::size_t i = 0; i < seen.p.size(); ++i) {
    from.sizes_m.push_back(0.03);
    from.headings_rad.push_back(0.1 * static_cast<double>(i));
    to.sizes_m.push_back(0.03 * (i < 10 ? 2.0 : i < 20 ? 0.5 : 1.1));
    to.headings_rad.push_back(from.headings_rad.back() - kTrueMotion.theta + (i < 30 ? 0.1 : 0.9));
  }
  const Registration result = register_pair(from, to, {}, 1);
  EXPECT_EQ(result.putative.size(), 40U);  // by size
  EXPECT_EQ(result.evidence.support, 10);  // of these, by turn
  EXPECT_THAT(result.reason, HasSubstr("10 matches agree, 12 are needed"));
}

}  // namespace
}  // namespace fathom

#include "fathom/vision/ransac.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include <gtest/gtest.h>

#include "src/vision/rigid_motion.hpp"
#include "vision/matched_points.hpp"

namespace fathom {
namespace {

using test::add_true;
using test::add_wrong;
using test::anywhere;
using test::kTruth;
using test::Pairs;
using test::Points;

TEST(Ransac, FindsTheMotionAmongMostlyWrongMatches) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    RandomStream random(seed);
    Pairs pairs;
    add_true(pairs, random, kTruth, 60, 0.005);
    add_wrong(pairs, random, 140);
    for (const int sample_size : {2, 3}) {
      RansacOptions options{.max_error_m = 0.03};
      options.sample_size = sample_size;
      const Consensus found = pairs.found(options, seed);
      ASSERT_TRUE(found.motion.has_value());
      EXPECT_NEAR(found.motion->x, kTruth.x, 0.005);
      EXPECT_NEAR(found.motion->y, kTruth.y, 0.005);
      EXPECT_NEAR(found.motion->theta, kTruth.theta, 0.01);
      EXPECT_GE(found.inliers.size(), 58U);
    }
  }
}

TEST(Ransac, TheMotionIsTheFitOfItsInliersAndNoMoreMatchesAgreeWithIt) {
  for (std::uint64_t seed = 20; seed < 40; ++seed) {
    RandomStream random(seed);
    Pairs pairs;
    add_true(pairs, random, kTruth, 80, 0.012);  // a good part beyond max_error_m
    add_wrong(pairs, random, 40);
    const RansacOptions options{.max_error_m = 0.03};
    const Consensus found = pairs.found(options);
    ASSERT_TRUE(found.motion.has_value());
    Points p;
    Points q;
    for (const int j : found.inliers) {
      p.push_back(pairs.p[static_cast<std::size_t>(j)]);
      q.push_back(pairs.q[static_cast<std::size_t>(j)]);
    }
    const double n = static_cast<double>(p.size());
    EXPECT_EQ(*found.motion, find_motion(p, q).value());
    EXPECT_NEAR(found.rms_m, std::sqrt(squared_error(*found.motion, p, q) / n), 1e-15);
    std::vector<int> within;
    for (std::size_t j = 0; j < pairs.p.size(); ++j) {
      const double error_m = (pairs.p[j] - transform(*found.motion, pairs.q[j])).norm();
      if (error_m <= *options.max_error_m) within.push_back(static_cast<int>(j));
    }
    // Settled, or a last round would have lost some.
    EXPECT_TRUE(within == found.inliers || within.size() < found.inliers.size());
  }
}

TEST(Ransac, SaysNotFoundWhereNothingAgrees) {
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    RandomStream random(seed);
    Pairs pairs;
    add_wrong(pairs, random, 300);
    const Consensus found = pairs.found({.max_error_m = 0.03}, seed);
    EXPECT_FALSE(found.motion.has_value());
    EXPECT_TRUE(found.inliers.empty());
    EXPECT_LT(found.most_inliers, 12);
  }
}

TEST(Ransac, CountsFromTheMinimumNumberOfInliers) {
  RandomStream random(30);
  Pairs pairs;
  add_true(pairs, random, kTruth, 11, 0.0);
  EXPECT_FALSE(pairs.found({.max_error_m = 0.03}).motion.has_value());
  EXPECT_EQ(pairs.found({.max_error_m = 0.03}).most_inliers, 11);
  add_true(pairs, random, kTruth, 1, 0.0);
  EXPECT_TRUE(pairs.found({.max_error_m = 0.03}).motion.has_value());
}

TEST(Ransac, ManyMatchesInFewPlacesAreFewVotes) {
  RandomStream random(50);
  Pairs pairs;
  for (int place = 0; place < 5; ++place) {
    const Eigen::Vector2d centre = anywhere(random);
    for (int i = 0; i < 10; ++i) pairs.add(kTruth, centre + 0.001 * anywhere(random));
  }
  RansacOptions options{.max_error_m = 0.03};
  const Consensus refused = pairs.found(options);
  EXPECT_FALSE(refused.motion.has_value());
  EXPECT_EQ(refused.most_inliers, 50);
  EXPECT_EQ(refused.most_places, 5);
  options.min_places = 5;
  EXPECT_TRUE(pairs.found(options).motion.has_value());
}

TEST(Ransac, ASpreadMatchedToOnePlaceIsNoPlacesAtAll) {
  // Fifty features of one picture taken for a single one of the other.
  RandomStream random(51);
  Pairs pairs;
  for (int i = 0; i < 50; ++i) {
    pairs.p.push_back(anywhere(random));
    pairs.q.push_back({0.3, 0.3});
  }
  EXPECT_FALSE(pairs.found({.max_error_m = 0.03}).motion.has_value());
}

TEST(Ransac, SamplesWithoutAHeadingAreDrawnAgain) {
  // Nine in ten matches are one match repeated: a sample that is not redrawn is nearly always it.
  RandomStream random(52);
  Pairs pairs;
  for (int i = 0; i < 180; ++i) pairs.add(kTruth, {0.1, 0.2});
  add_true(pairs, random, kTruth, 20, 0.001);
  RansacOptions options{.max_error_m = 0.03};
  options.iterations = 5;
  const Consensus found = pairs.found(options);
  ASSERT_TRUE(found.motion.has_value());
  EXPECT_NEAR(found.motion->theta, kTruth.theta, 0.02);
}

TEST(Ransac, AllInOnePlaceEndsAsNotFound) {
  Pairs pairs;
  for (int i = 0; i < 100; ++i) pairs.add(kTruth, {0.1, 0.2});
  const Consensus found = pairs.found({.max_error_m = 0.03});
  EXPECT_FALSE(found.motion.has_value());
  EXPECT_EQ(found.most_inliers, 0);
}

TEST(Ransac, SameSeedSameAnswer) {
  RandomStream random(60);
  Pairs pairs;
  add_true(pairs, random, kTruth, 40, 0.01);
  add_wrong(pairs, random, 100);
  const Consensus a = pairs.found({.max_error_m = 0.03}, 5);
  const Consensus b = pairs.found({.max_error_m = 0.03}, 5);
  ASSERT_TRUE(a.motion.has_value());
  EXPECT_EQ(*a.motion, *b.motion);
  EXPECT_EQ(a.inliers, b.inliers);
}

TEST(Ransac, TooFewOrBrokenPairsAreNotFound) {
  const Pairs none;
  EXPECT_FALSE(none.found({.max_error_m = 0.03}).motion.has_value());
  Pairs one;
  one.add(kTruth, {0.0, 0.0});
  EXPECT_FALSE(one.found({.max_error_m = 0.03}).motion.has_value());
  const double nan = std::numeric_limits<double>::quiet_NaN();
  Pairs broken;
  for (int i = 0; i < 50; ++i) {
    broken.p.emplace_back(nan, i);
    broken.q.emplace_back(i, nan);
  }
  EXPECT_FALSE(broken.found({.max_error_m = 0.03}).motion.has_value());
  EXPECT_THROW(ransac(broken.p, one.q, {}, 1), InputError);
}

TEST(Ransac, SampleAsLargeAsTheSetIsEveryPair) {
  RandomStream random(70);
  Pairs pairs;
  add_true(pairs, random, kTruth, 20, 0.001);
  RansacOptions options{.max_error_m = 0.03};
  options.sample_size = 20;
  options.iterations = 1;
  EXPECT_TRUE(pairs.found(options).motion.has_value());
  options.sample_size = 21;
  EXPECT_FALSE(pairs.found(options).motion.has_value());
}

TEST(RansacOptions, RefuseWhatMakesNoSense) {
  RansacOptions options{.max_error_m = 0.03};
  OptionTable table;
  options.describe(table);
  EXPECT_THROW(table.set("sample_size", OptionValue::scalar("1")), InputError);
  EXPECT_THROW(table.set("max_error_m", OptionValue::scalar("0")), InputError);
  EXPECT_THROW(table.set("min_inliers", OptionValue::scalar("2")), InputError);
  EXPECT_THROW(table.set("score", OptionValue::scalar("best")), InputError);
  table.set("score", OptionValue::scalar("paper"));
  EXPECT_EQ(options.score, RansacScore::paper);
}

}  // namespace
}  // namespace fathom

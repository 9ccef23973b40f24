// Candidates by possible_overlap, the default.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
#include "front_end/estimate.hpp"

namespace fathom {
namespace {

using test::by;
using test::candidates;
using test::Estimate;
using test::wide_camera;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Pictures of 2 m × 3 m that lie alike reach 0.9 · 3 m. The first is 5 m off: 2.3 m beyond, which
// 3.035 sigmas of 0.758 m cover and of 0.757 m do not. Between reach and overlap, 2.1 m ahead, no
// uncertainty is needed.
TEST(Candidates, ByPossibleOverlapAreThoseThatMaySeeTheSameFloor) {
  CandidateOptions options = by(CandidateMethod::possible_overlap);
  const auto found = [&](double sigma_m) {
    const Estimate estimate({{-5, 0, 0}, {0, 9, 0}, {0, -1.4, 0}, {2.1, 0, 0}, {0, 0, 0}},
                            {sigma_m, 1e-9, 1e-9, 1e-9});
    return candidates(options, estimate).keyframes;
  };
  EXPECT_THAT(found(0.757), ElementsAre(2, 3));
  EXPECT_THAT(found(0.758), ElementsAre(0, 2, 3));
  options.min_overlap = 0.5;  // reach 1.5 m: 3.5 m are left, 3.035 sigmas of 1.154 m
  EXPECT_THAT(found(1.153), ElementsAre(2));
  EXPECT_THAT(found(1.154), ElementsAre(0, 2));
}

// From 1 m and from 2 m, sides of 3 m and of 6 m: they share half of the lower one's at 3 m. The
// first keyframe is 5 m off: 2 m are left, 3.035 sigmas of 0.659 m.
TEST(Candidates, ByPossibleOverlapShareTheSmallerFootprint) {
  CandidateOptions options = by(CandidateMethod::possible_overlap);
  options.min_overlap = 0.5;
  for (const bool is_first_higher : {false, true}) {
    const std::vector<Stance> stances{is_first_higher ? 2.0 : 1.0, is_first_higher ? 1.0 : 2.0};
    const auto found = [&](double sigma_m) {
      return candidates(options, Estimate({{0, -5, 0}, {0, 0, 0}}, {sigma_m}), stances).keyframes;
    };
    EXPECT_THAT(found(0.658), IsEmpty());
    EXPECT_THAT(found(0.660), ElementsAre(0));
  }
}

TEST(Candidates, ByPossibleOverlapScaleWithTheAltitude) {
  CandidateOptions options = by(CandidateMethod::possible_overlap);
  RandomStream random(8, "altitude");
  std::vector<Pose> poses;
  for (int k = 0; k < 60; ++k) {
    poses.push_back({random.uniform(-9, 9), random.uniform(-9, 9), random.uniform(-3, 3)});
  }
  const auto at = [&](double scale) {
    std::vector<Pose> scaled = poses;
    for (Pose& pose : scaled) pose = {scale * pose.x, scale * pose.y, pose.theta};
    return candidates(options, Estimate(scaled, std::vector<double>(59, 0.4 * scale)),
                      std::vector<Stance>(60, scale))
        .keyframes;
  };
  EXPECT_GT(at(1.0).size(), 5u);
  for (const double scale : {0.25, 4.0, 16.0}) EXPECT_EQ(at(scale), at(1.0));
}

// Keyframes 0 to 2 and 5 to 7 passed by here, 3 and 4 did not. The best of either pass come first,
// then the second best.
TEST(Candidates, OfPossibleOverlapsTheBudgetTakesTheBestOfEachPass) {
  CandidateOptions options = by(CandidateMethod::possible_overlap);
  const Estimate estimate({{-1.3, 1, 0},
                           {-0.5, 1, 0},
                           {0.7, 1, 0},
                           {20, 0, 0},
                           {30, 0, 0},
                           {-1.2, 0, 0},
                           {-0.8, 0, 0},
                           {-0.4, 0, 0},
                           {0, 0, 0}},
                          std::vector<double>(8, 1e-9));
  const auto best = [&](int count) {
    options.budget = count;
    const Candidates found = candidates(options, estimate);
    EXPECT_EQ(found.keyframes.size() + found.left_out, 6u);
    return found.keyframes;
  };
  EXPECT_THAT(best(1), ElementsAre(7));
  EXPECT_THAT(best(2), ElementsAre(1, 7));
  EXPECT_THAT(best(3), ElementsAre(1, 6, 7));
  EXPECT_THAT(best(4), ElementsAre(1, 2, 6, 7));
  EXPECT_THAT(best(6), ElementsAre(0, 1, 2, 5, 6, 7));
}

TEST(Candidates, AutomaticGoesByWhatIsGiven) {
  CandidateOptions options;
  EXPECT_EQ(options.method_in_force(), CandidateMethod::possible_overlap);
  EXPECT_TRUE(options.asks_covariances());
  options.max_distance_m = 2.0;
  EXPECT_EQ(options.method_in_force(), CandidateMethod::distance);
  EXPECT_FALSE(options.asks_covariances());
}

TEST(Candidates, ByDistanceNeedOne) {
  for (const CandidateMethod method : {CandidateMethod::distance, CandidateMethod::mahalanobis}) {
    CandidateOptions options;
    options.method = method;
    EXPECT_THROW(CandidateSearch(wide_camera(), options), InputError);
  }
}

}  // namespace
}  // namespace fathom

// Registrations that a cache knows.

#include <memory>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/front_end/front_end.hpp"
#include "fathom/front_end/pair_registrar.hpp"
#include "fathom/front_end/visual_odometry.hpp"
#include "front_end/floor_survey.hpp"
#include "front_end/map_cache.hpp"
#include "front_end/measured_frames.hpp"

namespace fathom {
namespace {

using test::at;
using test::bend;
using test::FloorSurvey;
using test::kSeed;
using test::MapCache;

TEST(PairRegistrar, WhatTheCacheKnowsDecodesNothing) {
  const FloorSurvey first(bend(5));
  const std::vector<MeasuredFrame> from{at(0), at(1), at(2), at(3)};
  MapCache cache;
  PairRegistrar cold(first, {}, {}, kSeed, &cache);
  const auto expected = cold.of_all(from, at(4));
  EXPECT_EQ(cold.registered(), 4u);
  EXPECT_EQ(cold.from_cache(), 0u);
  EXPECT_EQ(cache.size(), 4u);

  const FloorSurvey second(bend(5));
  PairRegistrar warm(second, {}, {}, kSeed, &cache);
  for (const MeasuredFrame& frame : from) warm.announce(frame, at(4));
  EXPECT_EQ(warm.of_all(from, at(4)), expected);
  EXPECT_EQ(warm.of(from[1], at(4)), expected[1]);
  EXPECT_EQ(warm.registered(), 0u);
  EXPECT_EQ(warm.from_cache(), 4u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(second.times_taken(i), 0) << i;
}

TEST(PairRegistrar, OtherPicturesSeedsOrOptionsMissTheCache) {
  const FloorSurvey survey(bend(2));
  MapCache cache;
  PairRegistrar(survey, {}, {}, kSeed, &cache).of(at(0), at(1));
  const auto from_cache = [&](const FloorSurvey& pictures, const FeatureOptions& features,
                              std::uint64_t seed) {
    PairRegistrar registrar(pictures, features, {}, seed, &cache);
    registrar.of(at(0), at(1));
    return registrar.from_cache();
  };
  EXPECT_EQ(from_cache(survey, {}, kSeed), 1u);
  EXPECT_EQ(from_cache(survey, {}, kSeed + 1), 0u);
  FeatureOptions fewer;
  fewer.max_features = 500;
  EXPECT_EQ(from_cache(survey, fewer, kSeed), 0u);
  FloorSurvey blank(bend(2));
  blank.make_blank(1);
  EXPECT_EQ(from_cache(blank, {}, kSeed), 0u);
}

// Two whole front ends, one after the other, and one cache.
struct Run {
  explicit Run(const FloorSurvey& survey, RegistrationCache* cache, bool visual_odometry)
      : registrar(survey, {}, {}, kSeed, cache),
        odometry(survey, registrar, {}),
        front_end(visual_odometry ? static_cast<const FrameSource&>(odometry) : survey, registrar,
                  options()) {
    std::vector<Pose> poses{Pose{}};
    struct View : TrajectoryView {
      explicit View(const std::vector<Pose>& given) : poses(given) {}
      std::size_t size() const override { return poses.size(); }
      Pose pose(std::size_t k) const override { return poses[k]; }
      const std::vector<Pose>& poses;
    };
    while (const auto keyframe = front_end.next_keyframe()) {
      if (keyframe->step) poses.push_back(compose(poses.back(), keyframe->step->motion));
      for (const RelativePose& z : front_end.register_newest(View(poses))) found.push_back(z);
    }
  }

  static FrontEndOptions options() {
    FrontEndOptions options;
    options.keyframes.separation_frames = 2;
    options.candidates.max_distance_m = 0.9;
    return options;
  }

  PairRegistrar registrar;
  VisualOdometry odometry;
  FrontEnd front_end;
  std::vector<RelativePose> found;
};

void expect_warm_run_decodes_nothing(bool visual_odometry) {
  const auto survey = [&] {
    auto made = std::make_unique<FloorSurvey>(bend(9));
    made->add_odometry(1e-4 * Eigen::Matrix3d::Identity());
    return made;
  };
  MapCache cache;
  const auto first = survey();
  const auto second = survey();
  const Run cold(*first, &cache, visual_odometry);
  const Run warm(*second, &cache, visual_odometry);
  EXPECT_GT(cold.registrar.registered(), 4u);
  EXPECT_EQ(warm.registrar.registered(), 0u);
  EXPECT_EQ(warm.registrar.from_cache(), cold.registrar.registered());
  ASSERT_FALSE(cold.found.empty());
  ASSERT_EQ(warm.found.size(), cold.found.size());
  for (std::size_t i = 0; i < cold.found.size(); ++i) {
    EXPECT_EQ(warm.found[i].motion, cold.found[i].motion);
    EXPECT_EQ(warm.found[i].information, cold.found[i].information);
  }
  for (std::size_t i = 0; i < 9; ++i) {
    EXPECT_LE(first->times_taken(i), 1) << i;
    EXPECT_EQ(second->times_taken(i), 0) << i;
  }
}

TEST(PairRegistrar, ASecondRunDecodesNothing) {
  expect_warm_run_decodes_nothing(false);
}

TEST(PairRegistrar, ASecondRunWithVisualOdometryDecodesNothing) {
  expect_warm_run_decodes_nothing(true);
}

}  // namespace
}  // namespace fathom

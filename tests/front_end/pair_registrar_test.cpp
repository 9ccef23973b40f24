#include "fathom/front_end/pair_registrar.hpp"

#include <barrier>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/core/utility.hpp>

#include "fathom/front_end/pair_seed.hpp"
#include "front_end/floor_survey.hpp"
#include "front_end/map_cache.hpp"
#include "front_end/measured_frames.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::at;
using test::bend;
using test::FloorSurvey;
using test::input_error_of;
using test::kSeed;
using test::MapCache;
using ::testing::HasSubstr;

// With descriptors as they are extracted, as floats.
PairRegistration registered_plainly(const FloorSurvey& survey, const MeasuredFrame& from,
                                    const MeasuredFrame& to) {
  const auto seen = [&](const MeasuredFrame& m) {
    return on_floor(FeatureExtractor().extract(survey.image(m.frame)), survey.camera(),
                    m.altitude_m);
  };
  const Registration r =
      register_pair(seen(from), seen(to), {}, pair_seed(kSeed, from.frame, to.frame));
  return {r.found, r.motion, r.covariance, static_cast<int>(r.inliers.size()), r.shared, r.own};
}

TEST(PairRegistrar, GivesWhatPlainRegistrationGives) {
  const FloorSurvey survey(bend(3));
  PairRegistrar registrar(survey, {}, {}, kSeed);
  for (const auto& [from, to] : {std::pair(0, 1), {0, 2}, {2, 1}}) {
    const MeasuredFrame a = at(static_cast<std::size_t>(from));
    const MeasuredFrame b = at(static_cast<std::size_t>(to), 1.6);
    const PairRegistration expected = registered_plainly(survey, a, b);
    EXPECT_TRUE(expected.found);
    EXPECT_EQ(registrar.of(a, b), expected) << from << " -> " << to;
  }
}

TEST(PairRegistrar, RegistersEachPairOnce) {
  const FloorSurvey survey(bend(3));
  PairRegistrar registrar(survey, {}, {}, kSeed);
  const PairRegistration first = registrar.of(at(0), at(1));
  EXPECT_EQ(registrar.of(at(0), at(1)), first);
  EXPECT_EQ(registrar.registered(), 1u);
  registrar.of(at(1), at(0));
  registrar.of(at(0), at(1, 1.51));
  registrar.of(at(0, 1.51), at(1));
  EXPECT_EQ(registrar.registered(), 4u);
  // Other altitudes are other pairs, of the same features.
  for (const std::size_t frame : {0u, 1u}) EXPECT_EQ(survey.times_taken(frame), 1);
}

TEST(PairRegistrar, AllOfAListIsEachOfThem) {
  FloorSurvey survey(bend(6));
  survey.make_blank(2);
  const std::vector<MeasuredFrame> from{at(3), at(0), at(2), at(1), at(4, 1.7)};
  PairRegistrar one_by_one(survey, {}, {}, kSeed);
  std::vector<PairRegistration> expected;
  for (const MeasuredFrame& frame : from) expected.push_back(one_by_one.of(frame, at(5)));
  EXPECT_FALSE(expected[2].found);
  EXPECT_TRUE(expected[0].found);
  const int before = cv::getNumThreads();
  for (const int threads : {1, 2}) {
    cv::setNumThreads(threads);
    PairRegistrar registrar(survey, {}, {}, kSeed);
    registrar.of(from[3], at(5));
    EXPECT_EQ(registrar.of_all(from, at(5)), expected);
    EXPECT_EQ(registrar.registered(), 5u);
  }
  cv::setNumThreads(before);
  EXPECT_TRUE(one_by_one.of_all({}, at(5)).empty());
}

TEST(PairRegistrar, HasTheSameResultsWithoutRoomForFeatures) {
  const FloorSurvey survey(bend(4));
  PairRegistrar roomy(survey, {}, {}, kSeed);
  PairRegistrar cramped(survey, {}, {}, kSeed, nullptr, 0);
  const std::vector<MeasuredFrame> from{at(0), at(1), at(2)};
  EXPECT_EQ(cramped.of_all(from, at(3)), roomy.of_all(from, at(3)));
}

TEST(PairRegistrar, ThreadsThatNeedTheSameShareIt) {
  const FloorSurvey survey(bend(5));
  PairRegistrar registrar(survey, {}, {}, kSeed);
  constexpr std::size_t kThreads = 4;
  const std::vector<MeasuredFrame> from{at(0), at(1), at(2), at(3)};
  std::vector<std::vector<PairRegistration>> all(kThreads);
  std::vector<PairRegistration> single(kThreads);
  std::barrier start(kThreads);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      start.arrive_and_wait();
      single[t] = registrar.of(at(0), at(1));
      all[t] = registrar.of_all(from, at(4));
    });
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(registrar.registered(), 5u);
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(survey.times_taken(i), 1) << i;
  PairRegistrar alone(survey, {}, {}, kSeed);
  for (std::size_t t = 0; t < kThreads; ++t) {
    EXPECT_EQ(all[t], alone.of_all(from, at(4)));
    EXPECT_EQ(single[t], alone.of(at(0), at(1)));
  }
}

TEST(PairRegistrar, AFailureReachesAllWhoWaitAndIsNotKept) {
  FloorSurvey survey(bend(4));
  survey.make_unreadable(1);
  MapCache cache;
  PairRegistrar registrar(survey, {}, {}, kSeed, &cache);
  constexpr std::size_t kThreads = 4;
  std::vector<std::string> messages(kThreads);
  std::barrier start(kThreads);
  std::vector<std::thread> threads;
  const std::vector<MeasuredFrame> from{at(0), at(1), at(2)};
  for (std::size_t t = 0; t < kThreads; ++t) {
    threads.emplace_back([&, t] {
      start.arrive_and_wait();
      messages[t] = input_error_of([&] {
        if (t % 2 == 0) registrar.of(at(0), at(1));
        registrar.of_all(from, at(3));
      });
    });
  }
  for (std::thread& thread : threads) thread.join();
  for (const std::string& message : messages) EXPECT_EQ(message, "frame-1: is no picture");
  // The rest of the list was registered, nothing of the failed pairs was kept.
  EXPECT_EQ(registrar.registered(), 2u);
  EXPECT_EQ(cache.size(), 2u);
  const int taken = survey.times_taken(1);
  EXPECT_THAT(input_error_of([&] { registrar.of(at(0), at(1)); }), HasSubstr("frame-1"));
  EXPECT_GT(survey.times_taken(1), taken);
}

TEST(PairRegistrar, AnAltitudeThatIsNoneIsBadInput) {
  const FloorSurvey survey(bend(2));
  PairRegistrar registrar(survey, {}, {}, kSeed);
  registrar.of(at(0), at(1));
  EXPECT_THAT(input_error_of([&] { registrar.of(at(0), at(1, -1.0)); }), HasSubstr("altitude"));
  EXPECT_THAT(input_error_of([&] { registrar.of(at(0, NAN), at(1)); }), HasSubstr("altitude"));
}

TEST(PairRegistrar, AnnouncingExtractsAheadAndOnce) {
  FloorSurvey survey(bend(3));
  survey.make_unreadable(2);
  PairRegistrar registrar(survey, {}, {}, kSeed);
  registrar.announce(at(0), at(1));
  registrar.announce(at(0), at(1));
  registrar.announce(at(2), at(3));  // beyond the end
  registrar.announce(at(1), at(2));  // fails in the background
  EXPECT_TRUE(registrar.of(at(0), at(1)).found);
  EXPECT_EQ(survey.times_taken(1), 1);
  EXPECT_THAT(input_error_of([&] { registrar.of(at(1), at(2)); }), HasSubstr("frame-2"));
}

}  // namespace
}  // namespace fathom

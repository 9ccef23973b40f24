#include "fathom/evaluation/association.hpp"

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr std::int64_t kMillisecond = 1'000'000;

std::vector<StampedPose> at_ms(const std::vector<std::int64_t>& times_ms) {
  std::vector<StampedPose> trajectory;
  for (const std::int64_t time : times_ms) {
    trajectory.push_back({time * kMillisecond, {static_cast<double>(time), 0, 0}});
  }
  return trajectory;
}

TEST(Associate, EqualStamps) {
  const auto trajectory = at_ms({0, 10, 20, 35});
  EXPECT_THAT(associate(trajectory, trajectory, 0.0),
              ElementsAre(PosePair{0, 0}, PosePair{1, 1}, PosePair{2, 2}, PosePair{3, 3}));
}

TEST(Associate, TakesTheNearestAndLeavesTheRest) {
  const auto pairs = associate(at_ms({100, 200, 300}), at_ms({90, 104, 203, 250, 290}), 0.02);
  EXPECT_THAT(pairs, ElementsAre(PosePair{0, 1}, PosePair{1, 2}, PosePair{2, 4}));
}

TEST(Associate, IsOneToOne) {
  // Both estimates are nearest to 100 ms; the nearer one has it, the other finds the next.
  EXPECT_THAT(associate(at_ms({98, 101}), at_ms({90, 100}), 0.05),
              ElementsAre(PosePair{0, 0}, PosePair{1, 1}));
  EXPECT_THAT(associate(at_ms({98, 101}), at_ms({100}), 0.05), ElementsAre(PosePair{1, 0}));
}

TEST(Associate, NeverReachesAcrossAPair) {
  EXPECT_THAT(associate(at_ms({0, 100}), at_ms({99, 200}), 1.0), ElementsAre(PosePair{1, 0}));
}

TEST(Associate, EarlierOfEquallyNear) {
  EXPECT_THAT(associate(at_ms({10}), at_ms({5, 15}), 1.0), ElementsAre(PosePair{0, 0}));
  EXPECT_THAT(associate(at_ms({5, 15}), at_ms({10}), 1.0), ElementsAre(PosePair{0, 0}));
}

TEST(Associate, TheLimitIsIncluded) {
  EXPECT_THAT(associate(at_ms({0}), at_ms({10}), 0.01), ElementsAre(PosePair{0, 0}));
  std::vector<StampedPose> late = at_ms({10});
  late[0].time_ns += 1;
  EXPECT_THAT(associate(at_ms({0}), late, 0.01), IsEmpty());
}

TEST(Associate, UnixTimesAndTheFarthestStamps) {
  const std::int64_t unix_time = 1'700'000'000'123'456'789;
  const std::vector<StampedPose> a{{unix_time, {}}};
  const std::vector<StampedPose> b{{unix_time + 1, {}}};
  EXPECT_THAT(associate(a, b, 1e-9), ElementsAre(PosePair{0, 0}));
  EXPECT_THAT(associate(a, b, 0.0), IsEmpty());
  const std::vector<StampedPose> first{{std::numeric_limits<std::int64_t>::min(), {}}};
  const std::vector<StampedPose> last{{std::numeric_limits<std::int64_t>::max(), {}}};
  EXPECT_THAT(associate(first, last, 1.0), IsEmpty());
  EXPECT_THAT(associate(last, first, 1e12), ElementsAre(PosePair{0, 0}));
}

TEST(Associate, EmptyTrajectories) {
  EXPECT_THAT(associate({}, at_ms({1, 2}), 1.0), IsEmpty());
  EXPECT_THAT(associate(at_ms({1, 2}), {}, 1.0), IsEmpty());
}

// Every pair against every pair: nearest first, one to one, none across another.
std::vector<PosePair> naive(const std::vector<StampedPose>& estimate,
                            const std::vector<StampedPose>& reference, std::int64_t limit_ns) {
  struct Candidate {
    std::int64_t apart;
    PosePair pair;
  };
  std::vector<Candidate> all;
  for (std::size_t e = 0; e < estimate.size(); ++e) {
    for (std::size_t r = 0; r < reference.size(); ++r) {
      all.push_back({std::abs(estimate[e].time_ns - reference[r].time_ns), {e, r}});
    }
  }
  std::stable_sort(all.begin(), all.end(),
                   [](const Candidate& a, const Candidate& b) { return a.apart < b.apart; });
  std::vector<PosePair> pairs;
  for (const Candidate& candidate : all) {
    const PosePair& pair = candidate.pair;
    const bool free = std::none_of(pairs.begin(), pairs.end(), [&](const PosePair& taken) {
      return (taken.estimate <= pair.estimate) != (taken.reference < pair.reference) ||
             (taken.estimate < pair.estimate) != (taken.reference <= pair.reference);
    });
    const std::int64_t low =
        std::min(estimate[pair.estimate].time_ns, reference[pair.reference].time_ns);
    const std::int64_t high =
        std::max(estimate[pair.estimate].time_ns, reference[pair.reference].time_ns);
    const auto between = [&](const StampedPose& p) { return p.time_ns > low && p.time_ns < high; };
    const bool reaches_across = std::any_of(estimate.begin(), estimate.end(), between) ||
                                std::any_of(reference.begin(), reference.end(), between);
    if (candidate.apart <= limit_ns && free && !reaches_across) pairs.push_back(pair);
  }
  std::sort(pairs.begin(), pairs.end(),
            [](const PosePair& a, const PosePair& b) { return a.estimate < b.estimate; });
  return pairs;
}

TEST(Associate, EqualsTheNaiveSearch) {
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    RandomStream random(seed, "association");
    std::vector<StampedPose> trajectories[2];
    for (auto& trajectory : trajectories) {
      std::int64_t time = 0;
      for (int k = 0; k < 25; ++k) {
        time += 1 + static_cast<std::int64_t>(random.index(1'000'000'007));
        trajectory.push_back({time, {}});
      }
    }
    const double limit_s = random.uniform(0.0, 1.0);
    EXPECT_EQ(associate(trajectories[0], trajectories[1], limit_s),
              naive(trajectories[0], trajectories[1], std::llround(limit_s * 1e9)))
        << seed;
  }
}

TEST(Associate, Refuses) {
  const auto good = at_ms({1, 2});
  EXPECT_THAT(input_error_of([&] {
                associate(at_ms({2, 2}), good, 1.0);
              }),
              HasSubstr("of the estimate must rise; pose 1 at 0.002000000 s"));
  EXPECT_THAT(input_error_of([&] {
                associate(good, at_ms({3, 2}), 1.0);
              }),
              HasSubstr("of the reference must rise"));
  for (const double limit : {-1.0, std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THAT(input_error_of([&] { associate(good, good, limit); }), HasSubstr("0 s or more"));
  }
}

TEST(PairedPoses, AreThoseOfThePairs) {
  const auto estimate = at_ms({1, 2, 3});
  const auto reference = at_ms({10, 20});
  const std::vector<PosePair> pairs{{0, 1}, {2, 0}};
  const AssociatedPoses poses = paired_poses(estimate, reference, pairs);
  EXPECT_THAT(poses.estimate, ElementsAre(Pose{1, 0, 0}, Pose{3, 0, 0}));
  EXPECT_THAT(poses.reference, ElementsAre(Pose{20, 0, 0}, Pose{10, 0, 0}));
}

}  // namespace
}  // namespace fathom

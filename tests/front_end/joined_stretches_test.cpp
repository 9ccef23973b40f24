#include "fathom/front_end/joined_stretches.hpp"

#include <algorithm>
#include <map>
#include <numeric>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

TEST(JoinedStretches, WithoutAHoleAreOne) {
  JoinedStretches stretches;
  EXPECT_TRUE(stretches.are_one());
  stretches.extend(5, {});
  EXPECT_TRUE(stretches.are_one());
  EXPECT_TRUE(stretches.are_joined(0, 4));
}

TEST(JoinedStretches, ArePartedByHolesUntilTheyAreJoined) {
  JoinedStretches stretches;
  const std::vector<std::size_t> holes{2, 3, 5};
  stretches.extend(3, std::span(holes).first(1));
  EXPECT_TRUE(stretches.are_joined(0, 1));
  EXPECT_FALSE(stretches.are_joined(1, 2));
  EXPECT_FALSE(stretches.are_one());
  stretches.extend(6, holes);  // 0 1 | 2 | 3 4 | 5
  EXPECT_TRUE(stretches.are_joined(3, 4));
  stretches.join(5, 2);
  stretches.join(4, 0);
  EXPECT_TRUE(stretches.are_joined(2, 5));
  EXPECT_TRUE(stretches.are_joined(1, 3));
  EXPECT_FALSE(stretches.are_joined(2, 3));
  EXPECT_FALSE(stretches.are_one());
  stretches.join(3, 5);
  EXPECT_TRUE(stretches.are_joined(2, 0));
  EXPECT_TRUE(stretches.are_one());
  stretches.join(0, 5);
  EXPECT_TRUE(stretches.are_one());
}

TEST(InTurn, AllHaveItAtOnceWhereThereAreFew) {
  EXPECT_THAT(in_turn(0, 3, 1), IsEmpty());
  EXPECT_THAT(in_turn(3, 3, 7), ElementsAre(0, 1, 2));
  EXPECT_THAT(in_turn(3, 0, 7), IsEmpty());
}

// Turns go on by 5 of 11: 20 places of 2 at most.
TEST(InTurn, TurnsThatFollowEachOtherTakePlacesFarApart) {
  EXPECT_THAT(in_turn(20, 2, 0), ElementsAre(0, 11));
  EXPECT_THAT(in_turn(20, 2, 1), ElementsAre(5, 16));
  EXPECT_THAT(in_turn(20, 2, 2), ElementsAre(10));
  EXPECT_THAT(in_turn(20, 2, 3), ElementsAre(4, 15));
  EXPECT_THAT(in_turn(20, 2, 11), ElementsAre(0, 11));
}

std::size_t period(std::size_t count, std::size_t most) {
  std::size_t s = (count + most - 1) / most;
  while (s % 2 == 0 || s % 3 == 0) ++s;
  return s;
}

TEST(InTurn, TakesNoMoreThanItMayAndSpreadsThem) {
  for (std::size_t count = 1; count < 80; ++count) {
    for (std::size_t most = 1; most < count; ++most) {
      for (std::size_t turn = 0; turn < 7; ++turn) {
        const auto places = in_turn(count, most, turn);
        const std::size_t s = period(count, most);
        ASSERT_LE(places.size(), most);
        ASSERT_GE(places.size(), count / s);
        std::vector<std::size_t> gaps(places.size());
        std::adjacent_difference(places.begin(), places.end(), gaps.begin());
        for (std::size_t i = 0; i < places.size(); ++i) {
          ASSERT_LT(places[i], count);
          // The first one's is from the beginning.
          ASSERT_LE(gaps[i], s) << count << ' ' << most;
          ASSERT_TRUE(i == 0 || gaps[i] > 0);
        }
      }
    }
  }
}

// A second dive along the tracks of the first one, either way, or that stays where it is.
TEST(InTurn, APlaceHasItWithinAPeriodWhereverItGoes) {
  for (const auto& [count, most] :
       std::map<std::size_t, std::size_t>{{13, 12}, {30, 4}, {100, 12}, {101, 6}, {400, 12}}) {
    const std::size_t s = period(count, most);
    for (const int moves : {-1, 0, 1}) {
      for (std::size_t start = s; start + s < count; ++start) {
        bool has_had_it = false;
        for (std::size_t turn = 0; turn < s && !has_had_it; ++turn) {
          const std::size_t place = start + static_cast<std::size_t>(moves) * turn;
          has_had_it = std::ranges::binary_search(in_turn(count, most, 1000 + turn), place);
        }
        EXPECT_TRUE(has_had_it) << count << " places, moves by " << moves << " from " << start;
      }
    }
  }
}

}  // namespace
}  // namespace fathom

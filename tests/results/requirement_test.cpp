// Requirements as a user writes them.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/selection_runs.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using ::testing::HasSubstr;

TEST(ParseRequirement, TakesAllFourRelationsWithOrWithoutBlanks) {
  EXPECT_EQ(parse_requirement("total_ms<=20").text(), "total_ms <= 20");
  EXPECT_EQ(parse_requirement(" total_ms < 2e1 ").text(), "total_ms < 20");
  EXPECT_EQ(parse_requirement("anees >= 0.5").text(), "anees >= 0.5");
  EXPECT_EQ(parse_requirement("anees> -1").text(), "anees > -1");
}

TEST(ParseRequirement, TheBoundBelongsToItOrNot) {
  EXPECT_TRUE(parse_requirement("a<=1").holds(1.0));
  EXPECT_FALSE(parse_requirement("a<1").holds(1.0));
  EXPECT_TRUE(parse_requirement("a<1").holds(0.5));
  EXPECT_TRUE(parse_requirement("a>=1").holds(1.0));
  EXPECT_FALSE(parse_requirement("a>1").holds(1.0));
  EXPECT_TRUE(parse_requirement("a>1").holds(1.5));
}

TEST(ParseRequirement, RefusesAnythingElseWithAnExample) {
  for (const char* const text :
       {"", "total_ms", "total_ms=20", "total_ms=<20", "total_ms=>20", "<=20",
        "total_ms<=", "total_ms<=20 ms", "total_ms<=nan", "a<b<1", "total ms<=1", "total_ms<>3"}) {
    EXPECT_THAT(input_error_of([&] { parse_requirement(text); }),
                HasSubstr("for example 'mean_position_error_m <= 0.1'"))
        << text;
  }
}

}  // namespace
}  // namespace fathom

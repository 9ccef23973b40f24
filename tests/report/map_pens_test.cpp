#include "src/report/map_pens.hpp"

#include <limits>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/plot_series.hpp"

namespace fathom::test {
namespace {

TEST(MapPens, OnlyEstimatesThatAreNowhereFartherTakeTurns) {
  const std::vector<Pose> path{
      {0, 0, 0}, {40, 0, 0}, {std::numeric_limits<double>::quiet_NaN(), 0, 0}};
  std::vector<PlotSeries> all;
  for (std::size_t i = 0; i < 6; ++i) all.push_back(series_of(i, path));
  all[0].name = kTrueLine;
  all[2].poses[1].y = 0.2;
  all[4].poses[2].x = 40.0;
  all[5].poses[1].y = -0.1;
  const std::vector<Pen> alone = map_pens(all);
  std::vector<Pen> pens = alone;
  EXPECT_TRUE(take_turns(all, 0.15, pens));
  for (const std::size_t i : {0U, 2U, 4U}) {
    EXPECT_EQ(pens[i].dashes, alone[i].dashes) << i;
    EXPECT_EQ(pens[i].width, alone[i].width) << i;
  }
  EXPECT_THAT(pens[1].dashes, testing::IsEmpty());
  for (const std::size_t i : {3U, 5U}) {
    EXPECT_EQ(pens[i].width, pens[1].width);
    ASSERT_EQ(pens[i].dashes.size(), 2U);
    EXPECT_EQ(pens[i].dashes[1], 2.0 * pens[i].dashes[0]);
  }
  EXPECT_EQ(pens[3].dash_offset, -pens[3].dashes[0]);
  EXPECT_EQ(pens[5].dash_offset, -2.0 * pens[3].dashes[0]);
  pens = alone;
  EXPECT_FALSE(take_turns(std::span(all).first(3), 0.15, pens));
}

}  // namespace
}  // namespace fathom::test

// Trajectories of any format are read in time by their length.

#include "support/growth.hpp"

#include <cstddef>
#include <fmt/format.h>
#include <fstream>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/geometry/trajectory_file.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

TEST(TrajectoryGrowth, PosesTakeTimeByTheirNumber) {
  const std::vector<std::pair<TrajectoryFormat, std::string>> formats{
      {TrajectoryFormat::tum, "{}.5 {} 0 0 0 0 0 1\n"},
      {TrajectoryFormat::euroc, "{}000000000,{},0,0,1,0,0,0\n"},
      {TrajectoryFormat::kitti, "1 0 0 {} 0 1 0 {} 0 0 1 0\n"}};
  const test::TemporaryFolder folder;
  for (const auto& [format, line] : formats) {
    const auto read = [&, is = format, row = line](std::size_t poses) {
      std::string text;
      for (std::size_t i = 0; i < poses; ++i) text += fmt::format(fmt::runtime(row), i, i % 7);
      std::ofstream(folder / "poses.txt") << text;
      EXPECT_EQ(read_trajectory({folder / "poses.txt", is, {}}).poses.size(), poses);
    };
    EXPECT_LT(test::growth_of(read, 2000), test::kFarBelowTheSquare) << line;
  }
}

// Every second row is late: as many stretches as rows.
TEST(TrajectoryGrowth, SoDoesWhatIsWrongWithTheirTimes) {
  const test::TemporaryFolder folder;
  const auto refuse = [&](std::size_t poses) {
    std::string text;
    for (std::size_t i = 0; i < poses; ++i) {
      text += fmt::format("{}.0 0 0 0 0 0 0 1\n", i % 2 == 0 ? i + 5 : i);
    }
    std::ofstream(folder / "poses.tum") << text;
    EXPECT_NE(test::input_error_of([&] {
                read_trajectory({folder / "poses.tum", {}, {}});
              }).find("time goes back"),
              std::string::npos);
  };
  EXPECT_LT(test::growth_of(refuse, 2000), test::kFarBelowTheSquare);
}

}  // namespace
}  // namespace fathom

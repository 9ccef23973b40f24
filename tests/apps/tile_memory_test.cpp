// What a mosaic takes in memory, whole and by tiles, and what files of others do.

#include <cstdint>
#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "fathom/core/limits.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

class TileMemory : public CommandLine {
 protected:
  // The most that the program ever held, MiB.
  double peak_MiB(const Arguments& arguments, int status = 0) const {
    double peak = 0.0;
    const Ended ended = fathom(arguments, [&](pid_t process) {
      std::ifstream lines("/proc/" + std::to_string(process) + "/status");
      for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("VmHWM:")) peak = std::stod(line.substr(6)) / 1024.0;
      }
    });
    EXPECT_EQ(ended.status, status) << ended.err;
    return peak;
  }
};

TEST_F(TileMemory, OfTilesDoesNotGrowWithTheMosaic) {
  if (!FATHOM_MEASURES_MEMORY) GTEST_SKIP() << "a sanitizer takes memory of its own";
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out", "--no-mosaic"});
  // 60 megapixels, whole at 9 bytes each: 540 MiB.
  const Arguments large{"mosaic", "out", "--resolution", "0.00062", "--quiet", "--out"};
  const auto with = [&](std::initializer_list<std::string> more) {
    Arguments all = large;
    all.insert(all.end(), more);
    return all;
  };
  const double whole = peak_MiB(with({"whole"}));
  const double tiles = peak_MiB(with({"tiles", "--tile-size", "512"}));
  EXPECT_GT(whole, 400.0);
  EXPECT_LT(tiles, 0.4 * whole);
  RecordProperty("whole_MiB", static_cast<int>(whole));
  RecordProperty("tiles_MiB", static_cast<int>(tiles));
}

using ReaderMemory = TileMemory;

TEST_F(ReaderMemory, KeepsNoComments) {
  if (!FATHOM_MEASURES_MEMORY) GTEST_SKIP() << "a sanitizer takes memory of its own";
  std::string comments;
  for (int i = 0; i < 5'000'000; ++i) comments += "#\n";
  write("graph.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n" + comments);
  write("trajectory.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n" + comments);
  for (const char* const file : {"graph.g2o", "trajectory.tum"}) {
    EXPECT_LT(peak_MiB({"check", file}), 120.0) << file;
  }
}

// A file that is one hole, and rows of which each would take a hundred bytes.
TEST_F(ReaderMemory, WhatIsTooLargeIsNotHeld) {
  if (!FATHOM_MEASURES_MEMORY) GTEST_SKIP() << "a sanitizer takes memory of its own";
  write("graph.g2o", "");
  std::filesystem::resize_file(path("graph.g2o"), 3'000'000'000);
  EXPECT_LT(peak_MiB({"check", "graph.g2o"}, 2), 120.0);
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "folder"});
  std::string rows;
  for (std::uint64_t i = 0; i <= value_of(Limit::csv_rows); ++i) rows += "1,2\n";
  write("folder/mav0/altimeter0/data.csv", rows);
  EXPECT_LT(peak_MiB({"check", "folder"}, 2), 200.0);
}

}  // namespace
}  // namespace fathom::test

// Time stamps that do not rise: the cause by name, and a remedy that keeps every pose.

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/geometry/trajectory_file.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using Rows = std::vector<std::string>;

// Poses along x, 20 a second from `start_s` on.
Rows run_of(std::size_t poses, double start_s, const char* stamp = "{:.6f}", double y_m = 0.0) {
  Rows rows;
  for (std::size_t k = 0; k < poses; ++k) {
    const auto step = static_cast<double>(k);
    rows.push_back(fmt::format(fmt::runtime(stamp), start_s + 0.05 * step) +
                   fmt::format(" {:.3f} {:.3f} 0 0 0 0 1", 0.1 * step, y_m));
  }
  return rows;
}

std::string text_of(const Rows& rows) {
  std::string text;
  for (const std::string& row : rows) text += row + '\n';
  return text;
}

Rows behind(Rows rows, const Rows& more) {
  rows.insert(rows.end(), more.begin(), more.end());
  return rows;
}

class TrajectoryTimes : public testing::Test {
 protected:
  SpatialTrajectory read(const std::string& content) {
    write_file(file_, content);
    return read_trajectory({file_, {}, {}});
  }
  std::string error_of(const Rows& rows) {
    const std::string message = input_error_of([&] { read(text_of(rows)); });
    EXPECT_EQ(message.find('\n'), std::string::npos) << message;
    EXPECT_THAT(message, AllOf(Not(HasSubstr(" -u")), Not(HasSubstr("uniq"))));
    return message;
  }
  std::string at_line(std::size_t line) { return file_.string() + ":" + std::to_string(line); }
  // The command that a message names between the words, done in the folder.
  void obey(const std::string& message, const std::string& from, const std::string& to,
            const std::string& rest = "") {
    const std::size_t begin = message.find(from);
    ASSERT_NE(begin, std::string::npos) << message;
    const std::string command = message.substr(begin, message.find(to, begin) - begin);
    const std::string whole = "cd '" + folder_.path().string() + "' && " + command + rest;
    ASSERT_EQ(std::system((whole + " > said").c_str()), 0) << whole;
  }

  test::TemporaryFolder folder_;
  std::filesystem::path file_ = folder_ / "trajectory.txt";
};

TEST_F(TrajectoryTimes, OfSixDigitsAreOneTime) {
  EXPECT_THAT(
      error_of(run_of(40, 1403636579.0, "{:g}")),
      AllOf(StartsWith(at_line(2)),
            HasSubstr("40 poses have 1 time stamp between them, such as '1.40364e+09': too few "
                      "digits (6, which tell times 10000 s apart)"),
            HasSubstr("expected all digits, to be written where the file was made")));
  // Two decimals, of stamps that are 5 ms apart.
  EXPECT_THAT(error_of({"1403636579.76 0 0 0 0 0 0 1", "1403636579.77 1 0 0 0 0 0 1",
                        "1403636579.77 2 0 0 0 0 0 1", "1403636579.78 3 0 0 0 0 0 1"}),
              AllOf(StartsWith(at_line(3)), HasSubstr("4 poses have 3 time stamps between them"),
                    HasSubstr("too few digits (12, which tell times 0.01 s apart)")));
  // Zeros behind are no digits: what a 32-bit float makes of it, 128 s apart.
  EXPECT_THAT(error_of({"1403636608.000000 0 0 0 0 0 0 1", "1403636608.000000 1 0 0 0 0 0 1",
                        "1403636736.000000 2 0 0 0 0 0 1"}),
              Not(HasSubstr("digits (16")));
}

TEST_F(TrajectoryTimes, OfFewDigitsInEuRoC) {
  EXPECT_THAT(error_of({"1.7e+18,0,0,0,1,0,0,0", "1.7e+18,1,0,0,1,0,0,0", "1.8e+18,1,0,0,1,0,0,0"}),
              HasSubstr("too few digits (2, which tell times 1e+08 s apart)"));
}

TEST_F(TrajectoryTimes, TwoRunsAreCutWhereTheSecondBegins) {
  for (const double start_s : {100.0, 100.02, 101.0, 98.5, 20.0}) {
    Rows rows{"# t x y z qx qy qz qw"};
    rows = behind(behind(rows, run_of(40, 100.0)), run_of(50, start_s, "{:.6f}", 5.0));
    const std::string message = error_of(rows);
    EXPECT_THAT(message,
                AllOf(StartsWith(at_line(42)), HasSubstr("two runs in one file"),
                      HasSubstr("time goes back from '101.950000' to"), Not(HasSubstr("sort"))));
    obey(message, "csplit", " cuts");
    EXPECT_EQ(read_trajectory({folder_ / "run-00", {}, {}}).poses.size(), 40U);
    EXPECT_EQ(read_trajectory({folder_ / "run-01", {}, {}}).poses.size(), 50U);
  }
}

TEST_F(TrajectoryTimes, OneRunThreeTimes) {
  const Rows run = run_of(10, 7.0);
  const std::string message = error_of(behind(behind(run, run), run));
  EXPECT_THAT(message, AllOf(StartsWith(at_line(11)), HasSubstr("3 runs in one file"),
                             HasSubstr("trajectory.txt 11 21 cuts it at these lines")));
  // A short one behind a long one, too.
  EXPECT_THAT(error_of(behind(run_of(500, 7.0), run_of(6, 9.0))), HasSubstr("two runs"));
}

TEST_F(TrajectoryTimes, WhatIsOutOfOrderIsSortedAndKept) {
  const Rows run = run_of(60, 98.5, "{:.2f}");
  Rows swapped = run;
  std::swap(swapped[20], swapped[21]);
  Rows late = run;
  std::rotate(late.begin() + 10, late.begin() + 16, late.begin() + 30);
  Rows as_text = run;  // 100.00 before 98.50
  std::sort(as_text.begin(), as_text.end());
  Rows backwards(run.rbegin(), run.rend());
  Rows shuffled = run;
  for (std::size_t k = 0; k < run.size(); ++k) shuffled[k] = run[(k * 37) % run.size()];
  for (const Rows& rows : {swapped, late, backwards, shuffled}) {
    const std::string message = error_of(behind({"# head"}, rows));
    EXPECT_THAT(message, HasSubstr("the lines are not in the order of time"));
    obey(message, "LC_ALL=C sort", " orders", " trajectory.txt");
    const auto sorted = read_trajectory({folder_ / "said", {}, {}}).poses;
    ASSERT_EQ(sorted.size(), run.size());
    for (std::size_t k = 0; k < run.size(); ++k) {
      EXPECT_DOUBLE_EQ(sorted[k].pose.position_m.x(), std::round(static_cast<double>(k)) / 10.0);
    }
  }
}

TEST_F(TrajectoryTimes, LinesOfEuRoCAreSortedByTheirFirstColumn) {
  const std::string message =
      error_of({"#timestamp,x", "1403636579763555527,1,0,0,1,0,0,0",
                "1403636579763555526,0,0,0,1,0,0,0", "1403636580763555528,2,0,0,1,0,0,0"});
  EXPECT_THAT(message, StartsWith(at_line(3)));
  obey(message, "LC_ALL=C sort", " orders", " trajectory.txt");
  const auto sorted = read_trajectory({folder_ / "said", {}, {}}).poses;
  ASSERT_EQ(sorted.size(), 3U);
  EXPECT_EQ(sorted[0].time_ns, 1'403'636'579'763'555'526);
}

TEST_F(TrajectoryTimes, RepeatedRowsAndTwoPosesOfOneTime) {
  Rows run = run_of(20, 5.0);
  run.insert(run.begin() + 7, run[6]);
  EXPECT_THAT(error_of(run), AllOf(StartsWith(at_line(8)), HasSubstr("the row of line 7 again"),
                                   HasSubstr("(1 line repeat")));
  run[7].replace(run[7].size() - 1, 1, "1.0");
  run[7][run[7].find(' ') + 1] = '9';
  EXPECT_THAT(error_of(run), AllOf(StartsWith(at_line(8)), HasSubstr("line 7, of another pose"),
                                   HasSubstr("does not say which is right")));
}

TEST_F(TrajectoryTimes, ThoseOfKittiStayWithTheirPoses) {
  write_file(file_, "0\n0.1\n0.3\n0.2\n");
  EXPECT_THAT(input_error_of([&] { read_times(file_); }),
              AllOf(StartsWith(at_line(4)), HasSubstr("expected rising"), Not(HasSubstr("sort"))));
  write_file(file_, "1.4e+09\n1.4e+09\n1.4e+09\n");
  EXPECT_THAT(input_error_of([&] { read_times(file_); }), HasSubstr("too few digits (2, "));
}

}  // namespace
}  // namespace fathom

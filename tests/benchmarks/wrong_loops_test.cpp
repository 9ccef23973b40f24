// The table of wrong_loops: whose error is against what.

#include <cstdio>
#include <sstream>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

// Round a circle of 40 m, the heading drifting so far that the ends are metres apart, and the one
// loop that closes it: far outside the scale of a robust loss.
MeasurementLog circle() {
  constexpr std::size_t kSteps = 40;
  const Eigen::Matrix3d covariance = Eigen::Vector3d(1e-3, 1e-3, 1e-4).asDiagonal();
  MeasurementLog log;
  for (std::size_t k = 1; k <= kSteps; ++k) {
    log.add_keyframe(RelativePose::from_covariance(k - 1, k, {1.0, 0.0, 2.0 * M_PI / kSteps + 0.02},
                                                   covariance));
  }
  log.add_registration(RelativePose::from_covariance(0, kSteps, Pose{}, covariance));
  return log;
}

std::string output_of(const std::string& command) {
  std::string text;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return text;
  char buffer[256];
  while (std::fgets(buffer, sizeof buffer, pipe) != nullptr) text += buffer;
  EXPECT_EQ(pclose(pipe), 0) << command;
  return text;
}

// The cells of a back end's row of the Markdown table.
std::vector<std::string> row_of(const std::string& table, const std::string& back_end) {
  std::istringstream lines(table);
  for (std::string line; std::getline(lines, line);) {
    if (line.find("| " + back_end + " |") == std::string::npos) continue;
    std::vector<std::string> cells;
    for (const std::string_view cell : split(line, "|")) cells.emplace_back(trim(cell));
    return cells;
  }
  ADD_FAILURE() << "no row of " << back_end << " in\n" << table;
  return std::vector<std::string>(10);
}

// A robust back end that loses the loop of the clean graph is where dead reckoning is. Against its
// own clean result its error would be zero.
TEST(WrongLoops, OneReferenceForAllBackEnds) {
  const test::TemporaryFolder folder;
  const auto graph = folder.path() / "circle.g2o";
  write_file(graph, to_g2o(circle()));
  // In two steps: g++ 14 warns of the bounds of a temporary string that is appended to and moved.
  const std::string program = FATHOM_WRONG_LOOPS;
  const std::string table =
      output_of(program + " --seeds 1 --shares 0 --back-ends plain,dcs " + graph.string());
  constexpr std::size_t kMedianError = 4;
  constexpr std::size_t kRightLost = 7;
  const std::vector<std::string> plain = row_of(table, "plain");
  EXPECT_EQ(plain[kRightLost], "0 of 1") << table;
  EXPECT_LT(std::stod(plain[kMedianError]), 1e-3) << table;
  const std::vector<std::string> dcs = row_of(table, "dcs");
  EXPECT_EQ(dcs[kRightLost], "1 of 1") << table;
  EXPECT_GT(std::stod(dcs[kMedianError]), 1.0) << table;
}

}  // namespace
}  // namespace fathom

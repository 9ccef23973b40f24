// Poses that a program answers with: one for each node, and no doubt about which.

#include <stdexcept>
#include <string>

#include <gtest/gtest.h>

#include "estimators/command/dialogue.hpp"
#include "estimators/command/solver_files.hpp"

namespace fathom::command {
namespace {

template <class Action>
std::string failure_of(Action action) {
  try {
    action();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "none";
}

std::string failure_of_file(const std::string& text) {
  return failure_of([&] { poses_in(text, 2); });
}

TEST(CommandAnswers, AVertexIsThereOnce) {
  const std::string both = "VERTEX_SE2 1 1 2 0.5\nVERTEX_SE2 0 0 0 0\n";
  EXPECT_EQ(poses_in(both, 2)[1], (Pose{1, 2, 0.5}));
  EXPECT_EQ(failure_of_file(both + "VERTEX_SE2 1 1 3 0.5\n"), "its output has vertex 1 twice");
}

TEST(CommandAnswers, OtherLinesOfG2oAreIgnored) {
  const std::string spoken = "it took me 8 words to say so\n";
  EXPECT_EQ(poses_in(spoken + "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 2 0.5\n", 2)[1],
            (Pose{1, 2, 0.5}));
  EXPECT_EQ(failure_of_file(spoken), "its output is neither g2o nor TUM");
}

TEST(CommandAnswers, TimesOfTumRise) {
  EXPECT_EQ(poses_in("0 0 0 0 0 0 0 1\n1 1 2 0 0 0 0 1\n", 2)[1], (Pose{1, 2, 0}));
  for (const char* const first : {"1", "2"}) {
    EXPECT_EQ(failure_of_file(std::string(first) + " 0 0 0 0 0 0 1\n1 1 2 0 0 0 0 1\n"),
              "its output has times that do not rise");
  }
}

std::string failure_of_lines(const std::string& text) {
  std::size_t at = 0;
  const auto next = [&] {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) throw std::runtime_error("it has ended");
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    return line;
  };
  return failure_of([&] { answered_poses(next, 2); });
}

TEST(CommandAnswers, ByLinesANodeIsThereOnce) {
  const std::string both = "BEGIN\nVERTEX_XYT 0 0 0 0\nVERTEX_XYT 1 1 2 0.5\n";
  EXPECT_EQ(failure_of_lines(both + "END\n"), "none");
  EXPECT_EQ(failure_of_lines(both + "VERTEX_XYT 0 0 0 1\nEND\n"), "the answer has vertex 0 twice");
  EXPECT_EQ(failure_of_lines(both + "VERTEX_XYT 0 0 0 1 ;\nEND\n"),
            "expected 'VERTEX_XYT id x y theta' of a node, got 'VERTEX_XYT 0 0 0 1 ;'");
}

}  // namespace
}  // namespace fathom::command

// How long a file may be. clang-tidy looks after the length of functions (.clang-tidy).

#include <algorithm>
#include <map>
#include <string>

#include <gtest/gtest.h>

#include "architecture/checkout.hpp"

namespace fathom::test {
namespace {

constexpr long kMostLines = 250;

// Files that may be longer, by their path from the top of the checkout, each with the reason.
const std::map<std::string, std::string>& longer_files() {
  static const std::map<std::string, std::string> table{
      {"src/harness/replay.cpp", "one replay, from the first call of the estimator to the last"}};
  return table;
}

long lines_of(const std::string& file) {
  const std::string text = content_of(file);
  const bool has_open_end = !text.empty() && text.back() != '\n';
  return std::count(text.begin(), text.end(), '\n') + (has_open_end ? 1 : 0);
}

TEST(FileSize, IsBounded) {
  const auto files =
      files_below({"src", "include", "estimators", "adapters", "apps", "python", "tests",
                   "benchmarks", "examples", "scripts", "cmake", "docs/site"},
                  R"(.*\.(cpp|hpp|sh|cmake|js|py))");
  ASSERT_GT(files.size(), 300u);
  for (const std::string& file : files) {
    if (longer_files().contains(file)) continue;
    EXPECT_LE(lines_of(file), kMostLines) << file << ": split it, or name it with a reason here";
  }
}

TEST(FileSize, OnlyLongFilesAreNamedAsLonger) {
  for (const auto& [file, reason] : longer_files()) {
    EXPECT_GT(lines_of(file), kMostLines) << file << ": is gone, or no longer needs its entry";
    EXPECT_FALSE(reason.empty()) << file;
  }
}

}  // namespace
}  // namespace fathom::test

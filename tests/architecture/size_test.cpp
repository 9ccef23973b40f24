// How long a file may be. clang-tidy looks after the length of functions (.clang-tidy).

#include <algorithm>
#include <string>

#include <gtest/gtest.h>

#include "architecture/checkout.hpp"

namespace fathom::test {
namespace {

constexpr long kMostLines = 250;

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
    EXPECT_LE(lines_of(file), kMostLines) << file << ": split it";
  }
}

}  // namespace
}  // namespace fathom::test

// Gives every fuzzer its seeds and all that was a finding once: with any compiler, and without
// libFuzzer.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "targets.hpp"

namespace fathom::fuzz {
namespace {

namespace fs = std::filesystem;

std::vector<fs::path> inputs_of(const std::string& kind, const std::string& target) {
  const fs::path folder = fs::path(FATHOM_SOURCE_DIR) / "tests" / "fuzz" / kind / target;
  std::vector<fs::path> files;
  if (!fs::exists(folder)) return files;
  for (const auto& entry : fs::directory_iterator(folder)) files.push_back(entry.path());
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<std::uint8_t> bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), {}};
}

class FuzzTarget : public ::testing::TestWithParam<Target> {
 protected:
  static void run(const fs::path& file) {
    SCOPED_TRACE(file.string());
    const std::vector<std::uint8_t> bytes = bytes_of(file);
    EXPECT_EQ(GetParam().run(bytes.data(), bytes.size()), 0);
  }
};

TEST_P(FuzzTarget, TakesItsSeeds) {
  const std::vector<fs::path> seeds = inputs_of("seeds", GetParam().name);
  EXPECT_FALSE(seeds.empty()) << "a fuzzer needs a seed to begin with";
  for (const fs::path& seed : seeds) {
    EXPECT_LE(fs::file_size(seed), 2048u) << seed;
    run(seed);
  }
}

TEST_P(FuzzTarget, TakesWhatWasAFinding) {
  for (const fs::path& finding : inputs_of("findings", GetParam().name)) run(finding);
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTarget, ::testing::ValuesIn(kTargets),
                         [](const auto& target) { return std::string(target.param.name); });

}  // namespace
}  // namespace fathom::fuzz

#include "src/report/file_names.hpp"

#include <set>
#include <string>

#include <gtest/gtest.h>

namespace fathom {
namespace {

TEST(FileNames, AreSafe) {
  FileNames names;
  EXPECT_EQ(names.unique("nees separation 5"), "nees_separation_5");
  EXPECT_EQ(names.unique("noise 0.5, v-2"), "noise_0.5_v-2");
  EXPECT_EQ(names.unique("../../etc"), "_.._.._etc");
  EXPECT_EQ(names.unique("--out"), "_--out");
  EXPECT_EQ(names.unique("a/b\\c:d*?\"<>|\n"), "a_b_c_d");
  EXPECT_EQ(names.unique(""), "_");
  EXPECT_EQ(names.unique("σ"), "_-2");
}

TEST(FileNames, AreShortAndNoTwoTheSame) {
  FileNames names;
  std::set<std::string> seen;
  for (int i = 0; i < 200; ++i) {
    const std::string name = names.unique(std::string(300, 'x') + std::to_string(i));
    EXPECT_LE(name.size(), 80U);
    EXPECT_TRUE(seen.insert(name).second);
  }
  EXPECT_EQ(names.unique("Noise"), "Noise");
  EXPECT_EQ(names.unique("noise"), "noise-2");
}

}  // namespace
}  // namespace fathom

#include "fathom/core/text.hpp"

#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"

namespace fathom {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

TEST(Split, AtAnyRunOfBlanks) {
  EXPECT_THAT(split("  a\tb  c\r"), ElementsAre("a", "b", "c"));
  EXPECT_THAT(split("one"), ElementsAre("one"));
  EXPECT_THAT(split(" \t "), IsEmpty());
  EXPECT_THAT(split(""), IsEmpty());
  EXPECT_THAT(split("a.b..c", "."), ElementsAre("a", "b", "c"));
}

TEST(SplitCsv, KeepsEmptyFields) {
  EXPECT_THAT(split_csv("1, b ,,x\r"), ElementsAre("1", "b", "", "x"));
  EXPECT_THAT(split_csv(""), ElementsAre(""));
  EXPECT_THAT(split_csv(","), ElementsAre("", ""));
}

TEST(Trim, TakesBlanksOffBothEnds) {
  EXPECT_EQ(trim(" \t a b\r\n"), "a b");
  EXPECT_EQ(trim(" \n"), "");
  EXPECT_EQ(trim(""), "");
}

using NumberedLines = std::vector<std::pair<std::size_t, std::string>>;

NumberedLines numbered(TextLines lines) {
  NumberedLines all;
  for (const auto& [number, text] : lines) all.emplace_back(number, text);
  return all;
}

TEST(Lines, HaveTheirNumbersAndNoBlanksAround) {
  const NumberedLines all{{1, ""}, {2, "a b"}, {3, ""}, {4, "c"}};
  for (const char* const text : {"\n a b\r\n \t\nc", "\n a b\r\n \t\nc\n"}) {
    EXPECT_EQ(numbered(all_lines_of(text)), all);
    EXPECT_EQ(numbered(lines_of(text)), (NumberedLines{{2, "a b"}, {4, "c"}}));
  }
  EXPECT_THAT(numbered(all_lines_of("")), IsEmpty());
  EXPECT_THAT(numbered(lines_of("\n\n")), IsEmpty());
  EXPECT_THAT(numbered(all_lines_of("\n\n")), testing::SizeIs(2));
}

TEST(Joined, EmptyWordsCount) {
  EXPECT_EQ(joined({}, ", "), "");
  EXPECT_EQ(joined({"a"}, ", "), "a");
  EXPECT_EQ(joined({"", "a", "", "b"}, ", "), ", a, , b");
}

TEST(ParseReal, WholeFiniteNumbersAlone) {
  EXPECT_EQ(parse_real("1.5"), 1.5);
  EXPECT_EQ(parse_real("-2e-3"), -0.002);
  EXPECT_EQ(parse_real("+7"), 7.0);
  EXPECT_EQ(parse_real(".5"), 0.5);
  EXPECT_EQ(parse_real("5."), 5.0);
  EXPECT_EQ(parse_real("4.9406564584124654e-324"), 4.9406564584124654e-324);
  for (const char* text : {"", " 1", "1 ", "1.5x", "x", "nan", "NaN", "inf", "-inf", "1e999", "+",
                           "-", "+-1", "++1", "0x10", "1,5", "1e", "--1"}) {
    EXPECT_FALSE(parse_real(text)) << text;
  }
}

TEST(ParseInteger, WholeNumbersAlone) {
  EXPECT_EQ(parse_integer("-12"), -12);
  EXPECT_EQ(parse_integer("+12"), 12);
  EXPECT_EQ(parse_integer("9223372036854775807"), std::numeric_limits<std::int64_t>::max());
  for (const char* text : {"", "1.0", "1e3", "9223372036854775808", "0x1", "+-3", "1 "}) {
    EXPECT_FALSE(parse_integer(text)) << text;
  }
}

TEST(Exact, ReadsBackToTheSameBits) {
  RandomStream random(1, "exact");
  for (int i = 0; i < 1000; ++i) {
    const double value = random.normal() * std::pow(10.0, random.uniform(-300.0, 300.0));
    EXPECT_EQ(parse_real(exact(value)), value);
    EXPECT_EQ(std::strtod(exact(value).c_str(), nullptr), value);
  }
  EXPECT_EQ(exact(0.5), "0.5");
  EXPECT_EQ(exact(-0.0), "-0");
}

TEST(SecondsText, DigitByDigit) {
  EXPECT_EQ(seconds_text(0), "0.000000000");
  EXPECT_EQ(seconds_text(1), "0.000000001");
  EXPECT_EQ(seconds_text(-1), "-0.000000001");
  EXPECT_EQ(seconds_text(-1'500'000'000), "-1.500000000");
  EXPECT_EQ(seconds_text(1'403'636'579'763'555'527), "1403636579.763555527");
  EXPECT_EQ(seconds_text(std::numeric_limits<std::int64_t>::max()), "9223372036.854775807");
  EXPECT_EQ(seconds_text(std::numeric_limits<std::int64_t>::min()), "-9223372036.854775808");
}

TEST(InQuotes, IsFitForOneLine) {
  EXPECT_EQ(in_quotes("tag"), "'tag'");
  EXPECT_EQ(in_quotes(std::string("a\n\x1b\x7f\0b", 6)), "'a????b'");
  EXPECT_EQ(in_quotes(std::string(60, 'x')), "'" + std::string(60, 'x') + "'");
  EXPECT_EQ(in_quotes(std::string(61, 'x')), "'" + std::string(60, 'x') + "…'");
  // Never cut inside a character: 59 letters, then one of two bytes.
  EXPECT_EQ(in_quotes(std::string(59, 'x') + "éé"), "'" + std::string(59, 'x') + "…'");
}

TEST(Nearest, AreWordsOfWhichItMayBeAMisspelling) {
  using Words = std::vector<std::string>;
  struct Case {
    const char* word;
    Words among;
    Words expected;
  };
  const Words options{"max_iterations", "tolerance", "gate_probability"};
  const Words of_data{"dataset.altitudes", "dataset.start.x_m", "dataset.altitude_m"};
  const Words flags{"--help", "--list", "--set", "--seed", "--quiet"};
  for (const auto& [word, among, expected] : std::vector<Case>{
           {"max_iteration", options, {"max_iterations"}},
           {"tolerence", options, {"tolerance"}},
           {"gate_probabilty", options, {"gate_probability"}},
           {"something_else_altogether", options, {}},
           {"x", {}, {}},
           {"orign", {"none", "origin", "se2", "yaw"}, {"origin"}},
           {"euroq", {"tum", "kitti", "euroc"}, {"euroc"}},
           {"xzz", {"xy", "xz", "yz", "fit"}, {"xz"}},
           {"q", {"x", "y", "z"}, {}},
           {"versoin", {"run", "init", "--version"}, {"--version"}},
           {"estimators.0.nam", {"estimators.0.type", "estimators.0.name"}, {"estimators.0.name"}},
           {"dataset.altitude", of_data, {"dataset.altitudes", "dataset.altitude_m"}},
           {"dataset.altitude_m", {"dataset.start.x_m", "dataset.sigma_m"}, {}},
           {"datset.altitude_m", of_data, {"dataset.altitude_m"}},
           {"--qiet", flags, {"--quiet"}},
           {"--qiet", {"--help", "--list"}, {}},
           {"--ot", flags, {}},
           {"--ot", {"--set", "--out"}, {"--out"}},
           {"0.0", {"0.01", "0.1"}, {"0.01"}},
           {"efk", {"ekf", "trajectory_iekf"}, {"ekf"}}}) {
    EXPECT_EQ(nearest(word, among), expected) << word;
  }
}

}  // namespace
}  // namespace fathom

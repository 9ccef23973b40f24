#include "fathom/core/yaml_limits.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace fathom {
namespace {

using ::testing::HasSubstr;

std::string repeated(const std::string& text, std::size_t times) {
  std::string all;
  for (std::size_t i = 0; i < times; ++i) all += text;
  return all;
}

// Each level holds the one before ten times.
std::string bomb(int levels) {
  std::string text = "l0: &a0 [x, x, x, x, x, x, x, x, x, x]\n";
  for (int i = 1; i < levels; ++i) {
    const std::string n = std::to_string(i);
    text += "l" + n + ": &a" + n + " [" + repeated("*a" + std::to_string(i - 1) + ",", 9) + "*a" +
            std::to_string(i - 1) + "]\n";
  }
  return text;
}

TEST(YamlLimits, WhatPeopleWriteIsWithinThem) {
  for (const std::string text :
       {"", "# nothing\n", "a: &x [1, 2]\nb: *x\nc: {d: *x}\n", "a: ~\nb: &n\nc: *n\n"}) {
    EXPECT_FALSE(yaml_excess(text)) << text;
  }
  EXPECT_FALSE(yaml_excess(bomb(4)));
  EXPECT_FALSE(yaml_excess("a: " + repeated("[", 31) + repeated("]", 31)));
  EXPECT_FALSE(yaml_excess("a: [" + repeated("1, ", 190'000) + "1]"));
}

TEST(YamlLimits, ABombOfAliasesIsCountedAndNotBuilt) {
  const auto excess = yaml_excess(bomb(12));
  ASSERT_TRUE(excess);
  EXPECT_EQ(excess->line, 6U);
  EXPECT_EQ(excess->what,
            "has too many keys and values, aliases counted as what they repeat; the limit is "
            "200000");
}

TEST(YamlLimits, ALongTextThatAliasesRepeatIsCounted) {
  const std::string text = "a: &a " + std::string(1'000'000, 'x') + "\nb: [*a, *a, *a, *a]\n";
  const auto excess = yaml_excess(text);
  ASSERT_TRUE(excess);
  EXPECT_EQ(excess->line, 2U);
  EXPECT_THAT(excess->what, HasSubstr("too many bytes"));
  EXPECT_THAT(excess->what, HasSubstr("the limit is 4000000"));
}

// yaml-cpp begins one empty document after the other there.
TEST(YamlLimits, WhatTheParserWouldReadWithoutAnEndIsNoYaml) {
  for (const std::string text : {"&x ,", "a: 1\n--- &x\n,\n"}) {
    const auto excess = yaml_excess(text);
    ASSERT_TRUE(excess) << text;
    EXPECT_THAT(excess->what, HasSubstr("is no YAML from here on; expected a value")) << text;
  }
  EXPECT_FALSE(yaml_excess("--- \n---\n--- a\n...\n---\n"));
}

TEST(YamlLimits, EveryLimitIsNamed) {
  EXPECT_EQ(yaml_excess(std::string(4'000'001, '#'))->what,
            "has 4000001 bytes; the limit is 4000000");
  EXPECT_THAT(yaml_excess("a: [" + repeated("1, ", 210'000) + "1]")->what,
              HasSubstr("the limit is 200000"));
  for (const std::string& text :
       {std::string(100'000, '['), "a: " + std::string(33, '['), repeated("{a: ", 5000),
        repeated("- ", 5000), repeated("? ", 5000),
        "a: &a " + repeated("[", 20) + repeated("]", 20) + "\nb: " + repeated("[", 20) + "*a"}) {
    const auto excess = yaml_excess(text);
    ASSERT_TRUE(excess) << text.substr(0, 20);
    EXPECT_THAT(excess->what, HasSubstr("nested too deeply")) << text.substr(0, 20);
    EXPECT_THAT(excess->what, HasSubstr("32")) << text.substr(0, 20);
  }
}

TEST(YamlLimits, AnAliasInsideOfWhatItNamesHasNoEnd) {
  for (const std::string text : {"a: &a [*a]\n", "b: &b {c: *b}\n", "b: &b [{c: [1, *b]}]\n"}) {
    const auto excess = yaml_excess(text);
    ASSERT_TRUE(excess) << text;
    EXPECT_THAT(excess->what, HasSubstr("in itself")) << text;
  }
}

TEST(YamlLimits, AFaultIsTheParsersToTell) {
  for (const std::string text : {"a: [1", "*none", "a: b: c", "\t- x"}) {
    EXPECT_FALSE(yaml_excess(text)) << text;
  }
}

}  // namespace
}  // namespace fathom

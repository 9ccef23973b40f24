// Configurations that would fill memory, or take for ever.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/settings_of.hpp"
#include "fathom/configuration/configuration.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/estimators/builtin.hpp"
#include "support/growth.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::settings_of;
using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;

std::string refusal_of(const std::string& yaml) {
  return input_error_of([&] { settings_of(yaml); });
}

// Lists of lists, each nine times the one before: 9^12 numbers.
std::string list_bomb() {
  std::string text = "[&a [1,1,1,1,1,1,1,1,1]";
  for (char name = 'b'; name < 'm'; ++name) {
    const std::string before = std::string("*") + static_cast<char>(name - 1);
    text += std::string(",&") + name + " [" + before;
    for (int i = 0; i < 8; ++i) text += "," + before;
    text += "]";
  }
  return text + "]";
}

TEST(ConfigurationLimits, BombsAreRefusedAtTheirLine) {
  EXPECT_THAT(refusal_of("seed: 1\na: " + list_bomb() + "\n"),
              HasSubstr("config.yaml:2: has too many keys and values, aliases counted as what they "
                        "repeat; the limit is 200000"));
  EXPECT_THAT(refusal_of("a: " + std::string(100'000, '[')),
              HasSubstr("config.yaml:1: is nested too deeply"));
  EXPECT_THAT(refusal_of(std::string(4'000'001, ' ')),
              HasSubstr("config.yaml: is too large; the limit is 4000000 bytes"));
}

TEST(ConfigurationLimits, HoldForAValueOfTheCommandLineAndForText) {
  for (const std::string& what :
       {list_bomb(), "&a [*a]" + std::string(), std::string(50'000, '[')}) {
    EXPECT_THAT(input_error_of([&] { parse_override("a=" + what); }),
                testing::MatchesRegex("--set .*: (has too many|is nested too).*"));
    EXPECT_THAT(input_error_of([&] { parse_settings("a: " + what, "a dictionary"); }),
                testing::MatchesRegex("a dictionary: (has too many|is nested too).*"));
  }
}

TEST(ConfigurationLimits, AKeyHasAtMost200Bytes) {
  const std::string longest(200, 'k');
  EXPECT_EQ(settings_of(longest + ": 1\n").all().size(), 1U);
  const std::string shown = "key '" + std::string(60, 'k') + "…' has ";
  EXPECT_THAT(refusal_of("a: 1\n" + longest + "k: 1\n"),
              EndsWith("config.yaml:2: " + shown + "201 bytes; the limit is 200"));
  EXPECT_THAT(refusal_of("? " + std::string(1'000'000, 'k') + "\n: 1\n"),
              EndsWith("config.yaml:1: " + shown + "1000000 bytes; the limit is 200"));
  const std::string half(150, 'k');
  EXPECT_THAT(refusal_of(half + ": {" + half + ": 1}\n"), HasSubstr("has 301 bytes"));
  const std::string message =
      input_error_of([&] { parse_override(std::string(1'000'000, 'k') + "=1"); });
  EXPECT_THAT(message, AllOf(HasSubstr(shown + "1000000 bytes"), EndsWith("the limit is 200")));
  EXPECT_LT(message.size(), 300U);
}

TEST(ConfigurationLimits, ALongValueIsShownByItsBeginning) {
  const Settings settings = settings_of("seed: " + std::string(1'000'000, '7') + "\n");
  const std::string message =
      input_error_of([&] { configure(settings, ConfigurationKind::single, builtin_estimators()); });
  EXPECT_THAT(message, HasSubstr("seed: expected a whole number"));
  EXPECT_LT(message.size(), 300U);
}

// A setting for each key, in the order of the file, found and overwritten by it.
TEST(ConfigurationLimits, SettingsTakeTimeByTheirNumber) {
  const auto settings = [](std::size_t keys) {
    Settings all;
    for (std::size_t i = 0; i < keys; ++i) {
      all.put({"group." + std::to_string(i), OptionValue::scalar("1"), "here"});
      all.put({"group." + std::to_string(i / 2), OptionValue::scalar("2"), "there"});
    }
    return all;
  };
  EXPECT_LT(test::growth_of(settings, 4000), test::kFarBelowTheSquare);
  const Settings some = settings(1000);
  ASSERT_EQ(some.all().size(), 1000U);
  EXPECT_EQ(some.all()[499].origin, "there");
  EXPECT_EQ(some.all()[500].key, "group.500");
  EXPECT_EQ(some.find("group.500")->origin, "here");
  EXPECT_EQ(some.find("group.1000"), nullptr);
  const Settings below = some.below("group.99");
  ASSERT_EQ(below.all().size(), 11U);
  EXPECT_EQ(below.all()[0].key, "");
  EXPECT_EQ(below.all()[1].key, "0");
}

TEST(ConfigurationLimits, FiftyThousandKeysAreSoonReadAndRefused) {
  const auto read = [](std::size_t keys) {
    std::string text;
    for (std::size_t i = 0; i < keys; ++i) text += "key" + std::to_string(i) + ": 1\n";
    const Settings settings = settings_of(text);
    EXPECT_EQ(settings.all().size(), keys);
    EXPECT_THAT(input_error_of(
                    [&] { configure(settings, ConfigurationKind::single, builtin_estimators()); }),
                EndsWith("config.yaml:1: unknown key 'key0'"));
  };
  EXPECT_LT(test::growth_of(read, 50'000 / 8), test::kFarBelowTheSquare);
}

TEST(ConfigurationLimits, AListOfEstimatorsAndASweepHaveAnEnd) {
  std::string estimators = "estimators:\n";
  for (int i = 0; i <= 1000; ++i) {
    estimators += "  - {type: ekf, name: e" + std::to_string(i) + "}\n";
  }
  EXPECT_THAT(input_error_of([&] {
                configure(settings_of(estimators), ConfigurationKind::comparison,
                          builtin_estimators());
              }),
              HasSubstr("config.yaml:1002: estimators: has more than 1000"));
  std::string sweep = "sweep:\n";
  for (int i = 0; i <= 100; ++i) {
    sweep +=
        "  - {key: k" + std::to_string(i) + ", name: n" + std::to_string(i) + ", values: [1]}\n";
  }
  EXPECT_THAT(input_error_of([&] { configure_study(settings_of(sweep), builtin_estimators()); }),
              HasSubstr("config.yaml:102: sweep: has more than 100 axes, the limit"));
}

TEST(ConfigurationLimits, ItemsOfAListAreNumberedWithoutAGap) {
  for (const std::string item : {"3", "01", "-0", "+1", "1x", "9999999999999999999"}) {
    EXPECT_THAT(input_error_of([&] {
                  configure(settings_of("estimators: [{type: ekf}, {type: ekf, name: b}]\n"
                                        "estimators." +
                                        item + ".type: ekf\n"),
                            ConfigurationKind::comparison, builtin_estimators());
                }),
                HasSubstr("numbered from 0 without a gap"))
        << item;
  }
}

}  // namespace
}  // namespace fathom

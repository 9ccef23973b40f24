#include "fathom/core/options.hpp"

#include <optional>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::ElementsAre;

enum class Score { paper, inliers };

struct RansacOptions {
  int iterations = 500;
  double max_error_m = 0.1;

  void describe(OptionTable& table) {
    table.integer("iterations", iterations, Range::at_least(1), "", "models tried");
    table.real("max_error_m", max_error_m, Range::positive(), "m", "error of an inlier");
  }
};

struct Options {
  bool mutual = true;
  Score score = Score::inliers;
  std::string type = "sift";
  std::string path;
  std::optional<double> gate;
  double ratio = 0.8;
  double any = -1e300;
  int seed = 0;
  std::vector<double> covariance{1, 0.5};
  RansacOptions ransac;

  void describe(OptionTable& table) {
    table.boolean("mutual", mutual, "check both ways");
    table.enumeration("score", score, {{"paper", Score::paper}, {"inliers", Score::inliers}},
                      "how the best is chosen");
    table.choice("type", type, {"sift", "orb"}, "features");
    table.text("path", path, "where");
    table.real_or_off("gate", gate, Range::between(0.5, 0.999), "", "probability");
    table.real("ratio", ratio, Range::between(0, 1), "", "ratio test");
    table.real("any", any, Range::any(), "", "anything");
    table.integer("seed", seed, Range::any(), "", "of all");
    table.reals("covariance", covariance, 2, "m^2", "pairs");
    table.group("ransac", ransac);
  }
};

class OptionsTest : public testing::Test {
 protected:
  OptionsTest() { options_.describe(table_); }

  void set(const std::string& key, const std::string& text) {
    table_.set(key, OptionValue::scalar(text));
  }
  std::string error_of(const std::string& key, const std::string& text) {
    return input_error_of([&] { set(key, text); });
  }
  std::string error_of_list(const std::string& key, std::vector<std::string> items) {
    return input_error_of([&] { table_.set(key, {std::move(items), true}); });
  }

  Options options_;
  OptionTable table_;
};

TEST_F(OptionsTest, DefaultsAreTheInitialisersOfTheFields) {
  std::vector<std::string> defaults;
  for (const OptionDescription& option : table_.descriptions()) {
    defaults.push_back(option.key + "=" + option.default_value);
    EXPECT_EQ(table_.value(option.key), option.default_value);
  }
  EXPECT_THAT(defaults,
              ElementsAre("mutual=true", "score=inliers", "type=sift", "path=", "gate=off",
                          "ratio=0.8", "any=-1e+300", "seed=0", "covariance=[1, 0.5]",
                          "ransac.iterations=500", "ransac.max_error_m=0.1"));
}

TEST(Options, AWholeNumberMayBeOff) {
  std::optional<int> most;
  OptionTable table;
  table.integer_or_off("most", most, Range::at_least(1), "keyframes", "so many at most");
  EXPECT_EQ(table.descriptions()[0].default_value, "off");
  EXPECT_EQ(table.descriptions()[0].range, ">= 1 or off");
  table.set("most", OptionValue::scalar("12"));
  EXPECT_EQ(most, 12);
  EXPECT_EQ(table.value("most"), "12");
  for (const std::string text : {"0", "1.5", "none"}) {
    EXPECT_EQ(input_error_of([&] { table.set("most", OptionValue::scalar(text)); }),
              "most: expected a whole number >= 1 or off, got '" + text + "'");
  }
  table.set("most", OptionValue::scalar("off"));
  EXPECT_EQ(most, std::nullopt);
}

TEST_F(OptionsTest, EverythingOfAnOptionIsDescribed) {
  const auto& last = table_.descriptions().back();
  EXPECT_EQ(last.type, "real");
  EXPECT_EQ(last.unit, "m");
  EXPECT_EQ(last.range, "> 0");
  EXPECT_EQ(last.help, "error of an inlier");
  EXPECT_EQ(table_.descriptions()[1].range, "paper | inliers");
  EXPECT_EQ(table_.descriptions()[4].range, ">= 0.5, <= 0.999 or off");
  EXPECT_EQ(table_.descriptions()[8].type, "list of real");
  EXPECT_TRUE(table_.has("ransac.iterations"));
  EXPECT_FALSE(table_.has("iterations"));
}

TEST_F(OptionsTest, SetsTheFields) {
  set("mutual", "false");
  set("score", "paper");
  set("type", "orb");
  set("path", "a b");
  set("gate", "0.99");
  set("ratio", "1");
  set("seed", "-2147483648");
  set("ransac.iterations", "7");
  table_.set("covariance", {{"1", "2", "3", "4"}, true});
  EXPECT_FALSE(options_.mutual);
  EXPECT_EQ(options_.score, Score::paper);
  EXPECT_EQ(options_.type, "orb");
  EXPECT_EQ(options_.path, "a b");
  EXPECT_EQ(options_.gate, 0.99);
  EXPECT_EQ(options_.ratio, 1.0);
  EXPECT_EQ(options_.seed, -2147483648);
  EXPECT_EQ(options_.ransac.iterations, 7);
  EXPECT_THAT(options_.covariance, ElementsAre(1, 2, 3, 4));
  EXPECT_EQ(table_.value("score"), "paper");
  EXPECT_EQ(table_.value("type"), "orb");
  EXPECT_EQ(table_.value("covariance"), "[1, 2, 3, 4]");
  EXPECT_EQ(table_.value("gate"), "0.99");
  set("gate", "off");
  EXPECT_FALSE(options_.gate);
  table_.set("covariance", {{}, true});
  EXPECT_THAT(options_.covariance, testing::IsEmpty());
}

TEST_F(OptionsTest, EveryRefusalSaysWhatWouldBeRight) {
  EXPECT_EQ(error_of("mutual", "yes"), "mutual: expected true or false, got 'yes'");
  EXPECT_EQ(error_of("score", "best"), "score: expected one of paper, inliers, got 'best'");
  EXPECT_EQ(error_of("type", "SIFT"), "type: expected one of sift, orb, got 'SIFT'");
  EXPECT_EQ(error_of("score", "papr"),
            "score: expected one of paper, inliers, got 'papr'; did you mean 'paper'?");
  EXPECT_EQ(error_of("gate", "0.4"), "gate: expected a number >= 0.5, <= 0.999 or off, got '0.4'");
  EXPECT_EQ(error_of("gate", "none"),
            "gate: expected a number >= 0.5, <= 0.999 or off, got 'none'");
  EXPECT_EQ(error_of("ratio", "1.01"), "ratio: expected a number >= 0, <= 1, got '1.01'");
  EXPECT_EQ(error_of("ratio", "nan"), "ratio: expected a number >= 0, <= 1, got 'nan'");
  EXPECT_EQ(error_of("any", "inf"), "any: expected a number, got 'inf'");
  EXPECT_EQ(error_of("ransac.max_error_m", "0"),
            "ransac.max_error_m: expected a number in m > 0, got '0'");
  EXPECT_EQ(error_of("ransac.max_error_m", "10 cm"),
            "ransac.max_error_m: expected a number in m > 0, got '10 cm'");
  EXPECT_EQ(error_of("ransac.iterations", "0"),
            "ransac.iterations: expected a whole number >= 1, got '0'");
  EXPECT_EQ(error_of("ransac.iterations", "2.5"),
            "ransac.iterations: expected a whole number >= 1, got '2.5'");
  EXPECT_EQ(error_of("ransac.iterations", ""),
            "ransac.iterations: expected a whole number >= 1, got ''");
  EXPECT_EQ(error_of("seed", "2147483648"), "seed: expected a whole number, got '2147483648'");
  EXPECT_EQ(error_of("covariance", "1"),
            "covariance: expected a list of a multiple of 2 numbers, got '1'");
}

TEST_F(OptionsTest, ListsWhereThereShouldBeNone) {
  for (const std::string key : {"mutual", "score", "type", "path", "gate", "ratio", "seed"}) {
    EXPECT_THAT(error_of_list(key, {"1", "2"}), testing::EndsWith("got '[1, 2]'")) << key;
    EXPECT_THAT(error_of_list(key, {"true"}), testing::StartsWith(key + ": expected ")) << key;
  }
  EXPECT_EQ(error_of_list("covariance", {"1", "2", "3"}),
            "covariance: expected a list of a multiple of 2 numbers, got '[1, 2, 3]'");
  EXPECT_EQ(error_of_list("covariance", {"1", "x"}),
            "covariance: expected a list of numbers, got '[1, x]'");
}

TEST_F(OptionsTest, ARefusedValueChangesNothing) {
  error_of("ratio", "7");
  error_of("score", "best");
  error_of("gate", "7");
  error_of_list("covariance", {"1", "x"});
  EXPECT_EQ(options_.ratio, 0.8);
  EXPECT_EQ(options_.score, Score::inliers);
  EXPECT_FALSE(options_.gate);
  EXPECT_THAT(options_.covariance, ElementsAre(1, 0.5));
}

TEST_F(OptionsTest, AnUnknownKeyNamesTheNearest) {
  EXPECT_EQ(error_of("ransac.max_eror_m", "1"),
            "unknown key 'ransac.max_eror_m'; did you mean 'ransac.max_error_m'?");
  EXPECT_EQ(error_of("something.else.altogether", "1"), "unknown key 'something.else.altogether'");
  EXPECT_EQ(input_error_of([&] { table_.value("rato"); }),
            "unknown key 'rato'; did you mean 'ratio'?");
}

TEST(Range, TextAndContents) {
  EXPECT_EQ(Range::any().text(), "");
  EXPECT_EQ(Range::positive().text(), "> 0");
  EXPECT_EQ(Range::at_least(2).text(), ">= 2");
  EXPECT_EQ(Range::between(-1, 0.5).text(), ">= -1, <= 0.5");
  EXPECT_FALSE(Range::positive().contains(0));
  EXPECT_TRUE(Range::at_least(2).contains(2));
  EXPECT_TRUE(Range::between(-1, 0.5).contains(0.5));
  EXPECT_FALSE(Range::between(-1, 0.5).contains(0.51));
  EXPECT_FALSE(Range::any().contains(std::numeric_limits<double>::quiet_NaN()));
}

TEST(InputErrorMessage, OpensWithFileAndLine) {
  EXPECT_STREQ(InputError("a.g2o", 7, "wrong").what(), "a.g2o:7: wrong");
  EXPECT_STREQ(InputError("a.g2o", "wrong").what(), "a.g2o: wrong");
  EXPECT_STREQ(InputError("wrong").what(), "wrong");
}

}  // namespace
}  // namespace fathom

#include "fathom/configuration/config_file.hpp"

#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/settings_of.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::settings_of;
using ::testing::ElementsAre;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::StartsWith;

std::vector<std::string> items(const Settings& settings, const std::string& key) {
  const Setting* setting = settings.find(key);
  return setting == nullptr ? std::vector<std::string>{"(none)"} : setting->value.items;
}

TEST(ReadSettings, TurnsMapsIntoDottedKeys) {
  const Settings settings = settings_of(
      "seed: 7\n"
      "front_end:\n"
      "  ransac: {iterations: 500, score: paper}\n"
      "  matching.ratio: 0.7\n");
  EXPECT_EQ(settings.all().size(), 4u);
  EXPECT_THAT(items(settings, "seed"), ElementsAre("7"));
  EXPECT_THAT(items(settings, "front_end.ransac.iterations"), ElementsAre("500"));
  EXPECT_THAT(items(settings, "front_end.ransac.score"), ElementsAre("paper"));
  EXPECT_THAT(items(settings, "front_end.matching.ratio"), ElementsAre("0.7"));
}

TEST(ReadSettings, KeepsFileAndLine) {
  const Settings settings =
      settings_of("# a comment\nseed: 7\nfront_end:\n  a: 1\n  b: [1,\n 2]\n");
  EXPECT_THAT(settings.find("seed")->origin, EndsWith("config.yaml:2"));
  EXPECT_THAT(settings.find("front_end.a")->origin, EndsWith("config.yaml:4"));
  EXPECT_THAT(settings.find("front_end.b")->origin, EndsWith("config.yaml:5"));
}

TEST(ReadSettings, FlattensNestedLists) {
  const Settings settings = settings_of("a: [[1, 2], [3, [4]]]\nb: []\nc: [x]\n");
  EXPECT_THAT(items(settings, "a"), ElementsAre("1", "2", "3", "4"));
  EXPECT_THAT(items(settings, "b"), IsEmpty());
  EXPECT_TRUE(settings.find("b")->value.is_list);
  EXPECT_TRUE(settings.find("c")->value.is_list);
}

TEST(ReadSettings, KeysAListOfMapsByPlace) {
  const Settings settings = settings_of("estimators:\n  - {type: ekf}\n  - {type: x, name: y}\n");
  EXPECT_THAT(items(settings, "estimators.0.type"), ElementsAre("ekf"));
  EXPECT_THAT(items(settings, "estimators.1.name"), ElementsAre("y"));
}

TEST(ReadSettings, TakesQuotesAliasesAndEmptyFiles) {
  EXPECT_THAT(items(settings_of("a: 'it''s: #1'\n"), "a"), ElementsAre("it's: #1"));
  EXPECT_THAT(items(settings_of("a: \"\"\n"), "a"), ElementsAre(""));
  EXPECT_THAT(items(settings_of("a: &x [1, 2]\nb: *x\n"), "b"), ElementsAre("1", "2"));
  EXPECT_THAT(settings_of("").all(), IsEmpty());
  EXPECT_THAT(settings_of("# nothing\n").all(), IsEmpty());
  EXPECT_THAT(settings_of("{}\n").all(), IsEmpty());
  EXPECT_THAT(settings_of("---\nseed: 1\n").all(), Not(IsEmpty()));
}

TEST(ReadSettings, RefusesWithFileAndLine) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"seed: 1\nseed: 2\n", "config.yaml:2: 'seed' is given twice"},
      {"a: {b: 1}\n\na.b: 2\n", "config.yaml:3: 'a.b' is given twice"},
      {"a.b: 2\na: {b: 1}\n", "config.yaml:2: 'a.b' is given twice"},
      {"a: 1\nb: [1, 2\nc: 3\n", "config.yaml:3: not YAML: "},
      {"a: 1\n\tb: 2\n", "config.yaml:2: not YAML: "},
      {"a: 1\nb: *none\n", "config.yaml:2: not YAML: "},
      {"a: 1\n b: 2\n", "config.yaml:2: not YAML: "},
      {"a: 1\nb:\nc: 2\n", "config.yaml:2: b: has no value"},
      {"a: 1\nb: ~\n", "config.yaml:2: b: has no value"},
      {"a: 1\nb: {}\n", "config.yaml:2: b: the map is empty"},
      {"a: 1\nb: {c: {}}\n", "config.yaml:2: b.c: the map is empty"},
      {"a: 1\nb: [{}]\n", "config.yaml:2: b.0: the map is empty"},
      {"a: 1\nb: [1, null]\n", "config.yaml:2: a list holds scalars or lists"},
      {"a: 1\nb: [1, {c: 2}]\n", "config.yaml:2: a list holds scalars or lists"},
      {"a: 1\nb: [{c: 2}, 1]\n", "config.yaml:2: b: expected a list of maps"},
      {"a: 1\n[1, 2]: 3\n", "config.yaml:2: a key must be a word"},
      {"- 1\n- 2\n", "config.yaml:1: expected a map of keys and values"},
      {std::string("seed: 1\n\0ed: 2\n", 15), "config.yaml: not YAML: holds a zero byte"},
      {"just words\n", "config.yaml:1: expected a map of keys and values"},
      {"seed: 1\n---\nseed: 2\n", "config.yaml:3: a second document"},
      {"a: &a [*a]\n", "config.yaml:1: is nested too deeply, or in itself"},
      {"a: 1\nb: &b {c: *b}\n", "config.yaml:2: is nested too deeply, or in itself"},
      {"b: &b [{c: *b}]\n", "config.yaml:1: is nested too deeply, or in itself"}};
  for (const auto& [text, message] : cases) {
    EXPECT_THAT(input_error_of([&, &yaml = text] { settings_of(yaml); }), HasSubstr(message))
        << text;
  }
}

TEST(ReadSettings, RefusesRubbishWithoutFallingOver) {
  const std::vector<std::string> cases{std::string(100'000, '['),
                                       std::string("\0\1\2", 3),
                                       "\xff\xfd[1",
                                       std::string(2000, '{'),
                                       "%YAML 99\n---\n[",
                                       "? \n: \n? \n: \n",
                                       "!!binary a: !<x> b\n: [",
                                       "<<: 1\n<<: 2"};
  for (const std::string& text : cases) {
    EXPECT_THAT(input_error_of([&] { settings_of(text); }), HasSubstr("config.yaml"))
        << text.substr(0, 20);
  }
}

TEST(ReadSettings, RefusesWhatIsNoFile) {
  const test::TemporaryFolder folder;
  EXPECT_THAT(input_error_of([&] { read_settings(folder / "none.yaml"); }),
              HasSubstr("none.yaml: cannot be opened; does it exist?"));
  EXPECT_THAT(input_error_of([&] { read_settings(folder.path()); }), HasSubstr("is a folder"));
}

TEST(Override, TakesScalarsAndLists) {
  const auto given = [](const std::string& text) {
    const Setting setting = parse_override(text);
    EXPECT_EQ(setting.origin, "--set " + text);
    return std::pair(setting.key, setting.value.items);
  };
  using Given = std::pair<std::string, std::vector<std::string>>;
  EXPECT_EQ(given("seed=7"), Given("seed", {"7"}));
  EXPECT_EQ(given(" a.b = 7 "), Given("a.b", {"7"}));
  EXPECT_EQ(given("a=[1, 2, [3]]"), Given("a", {"1", "2", "3"}));
  EXPECT_EQ(given("a=b=c"), Given("a", {"b=c"}));
  EXPECT_EQ(given("a="), Given("a", {""}));
  EXPECT_EQ(given("a='  x '"), Given("a", {"  x "}));
  EXPECT_EQ(given("path=/tmp/a b/c.png"), Given("path", {"/tmp/a b/c.png"}));
}

TEST(Override, TakesWhatIsNoYamlAsItIs) {
  for (const std::string text : {"[1, 2", "x: y", "{a: 1}", "*a", "#1", "a: b: c", "~", "\"x"}) {
    const Setting setting = parse_override("key=" + text);
    EXPECT_FALSE(setting.value.is_list);
    EXPECT_THAT(setting.value.items, ElementsAre(text));
  }
}

TEST(Override, SaysWhetherAListWasGiven) {
  EXPECT_TRUE(parse_override("a=[]").value.is_list);
  EXPECT_TRUE(parse_override("a=[1]").value.is_list);
  EXPECT_FALSE(parse_override("a=1").value.is_list);
}

TEST(Override, AMapInBracesIsOneSettingForEachOfItsKeys) {
  const auto keys_of = [](const std::string& text) {
    std::vector<std::string> keys;
    for (const Setting& one : parse_overrides(text)) {
      EXPECT_THAT(one.origin, StartsWith("--set " + text.substr(0, text.find('=') + 1)));
      keys.push_back(one.key + "=" + one.value.text());
    }
    return keys;
  };
  EXPECT_THAT(keys_of("dataset.origin={latitude: 39.5, longitude: 2.5}"),
              ElementsAre("dataset.origin.latitude=39.5", "dataset.origin.longitude=2.5"));
  EXPECT_THAT(keys_of("a = {b: {c: 1, d: [2, 3]}}"), ElementsAre("a.b.c=1", "a.b.d=[2, 3]"));
  EXPECT_THAT(keys_of("seed=7"), ElementsAre("seed=7"));
  EXPECT_THAT(keys_of("path=a b: c"), ElementsAre("path=a b: c"));
  for (const std::string text : {"a={}", "a={b}", "a={b: 1", "a={b: 1, b: 2}"}) {
    EXPECT_THAT(input_error_of([&] { parse_overrides(text); }), HasSubstr("--set a="));
  }
}

TEST(Override, RefusesWhatIsNoPair) {
  for (const std::string text : {"seed", "=7", "", "="}) {
    EXPECT_THAT(input_error_of([&] { parse_override(text); }),
                HasSubstr("--set " + text + ": expected KEY=VALUE, for example seed=7"));
  }
  for (const std::string text :
       {"estimators=[{type: ekf}]", "estimators=[{type: ekf}, {type: ekf}]"}) {
    EXPECT_THAT(input_error_of([&] { parse_override(text); }),
                HasSubstr("for example estimators.0.type=ekf"));
  }
  EXPECT_EQ(input_error_of([&] { parse_override("a=[{}]"); }),
            "--set a=[{}]: a.0: the map is empty");
}

TEST(Settings, ALaterOneReplacesAnEarlierOneInItsPlace) {
  Settings settings = settings_of("a: 1\nb: 2\n");
  settings.put(parse_override("a=3"));
  settings.put(parse_override("c=4"));
  ASSERT_EQ(settings.all().size(), 3u);
  EXPECT_EQ(settings.all()[0].key, "a");
  EXPECT_THAT(items(settings, "a"), ElementsAre("3"));
  EXPECT_EQ(settings.find("a")->origin, "--set a=3");
  EXPECT_EQ(settings.find("d"), nullptr);
}

TEST(Settings, BelowTakesThePrefixOff) {
  const Settings part = settings_of("a: {b: 1, c: {d: 2}}\nab: 3\n").below("a.");
  ASSERT_EQ(part.all().size(), 2u);
  EXPECT_THAT(items(part, "b"), ElementsAre("1"));
  EXPECT_THAT(items(part, "c.d"), ElementsAre("2"));
}

TEST(Settings, AWordIsOneScalar) {
  EXPECT_EQ(word_of(parse_override("type=ekf"), "estimator.type"), "ekf");
  for (const std::string text : {"type=[]", "type=[ekf]", "type=[a, b]"}) {
    EXPECT_EQ(input_error_of([&] { word_of(parse_override(text), "estimator.type"); }),
              "--set " + text + ": estimator.type: expected a single word");
  }
}

}  // namespace
}  // namespace fathom

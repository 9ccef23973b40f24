#include "fathom/configuration/config_text.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "configuration/settings_of.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::settings_of;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(ConfigText, EveryWordIsReadBackAsItWas) {
  for (const std::string word :
       {"",         "plain",      "true",       "~",          "null",   "1e3",
        "010",      "it's",       "\"quoted\"", "a: b",       "a #b",   "#b",
        "- a",      "[a]",        "{a: b}",     "&a",         "*a",     "!a",
        "%a",       " a ",        "tab\there",  "two\nlines", "back\\", "gr\u00fcn/\u6c34",
        "a\u00a0b", "\U0001F41F", "\x7f"}) {
    const Settings read = settings_of(config_text({{"a.b.c", word, false, ""}}));
    ASSERT_EQ(read.all().size(), 1U) << word;
    EXPECT_EQ(read.all()[0].key, "a.b.c");
    EXPECT_FALSE(read.all()[0].value.is_list) << word;
    EXPECT_THAT(read.all()[0].value.items, ElementsAre(word));
  }
}

TEST(ConfigText, ListsAndCommentsAreReadBack) {
  const Settings read = settings_of(config_text({{"a.b", "[1, two words, \"3, 4\"]", true, ""},
                                                 {"a.c.d", "x", false, "a comment:\nof two"},
                                                 {"e", "[not, a, list]", false, ""}}));
  ASSERT_EQ(read.all().size(), 3U);
  EXPECT_THAT(read.find("a.b")->value.items, ElementsAre("1", "two words", "3, 4"));
  EXPECT_THAT(read.find("a.c.d")->value.items, ElementsAre("x"));
  EXPECT_THAT(read.find("e")->value.items, ElementsAre("[not, a, list]"));
}

// In quotes the emitter writes another character in their place, and a path would be another one.
TEST(ConfigText, BytesThatWouldBeReadBackAsOthersAreRefused) {
  EXPECT_EQ(settings_of(config_text({{"path", "a\xff", false, ""}})).all()[0].value.items[0],
            "a\xff");
  EXPECT_THAT(input_error_of([] {
                config_text({{"path", "a: \xff", false, ""}});
              }),
              HasSubstr("not UTF-8"));
  EXPECT_THAT(input_error_of([] {
                config_text({{"paths", "[b, 'a: \xff']", true, ""}});
              }),
              HasSubstr("not UTF-8"));
}

}  // namespace
}  // namespace fathom

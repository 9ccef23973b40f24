#include "fathom/core/utf8.hpp"

#include <gtest/gtest.h>

#include "fathom/core/program.hpp"
#include "fathom/core/random.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

TEST(Printable, TextStaysAsItIs) {
  for (const char* const text :
       {"", "plain", "two\nlines\n", "a\ttab", "σ ≤ 0.5 m, Größe, 海底, 🐟", "\n\n"}) {
    EXPECT_EQ(printable(text), text);
  }
}

TEST(Printable, WhatATerminalWouldObeyIsWrittenOut) {
  EXPECT_EQ(printable("\x1b[31mred"), "<U+001B>[31mred");
  EXPECT_EQ(printable("over\rwritten"), "over<U+000D>written");
  EXPECT_EQ(printable("\x7f"), "<U+007F>");
  EXPECT_EQ(printable("\u009b31m"), "<U+009B>31m");            // CSI of C1
  EXPECT_EQ(printable("a\u202etxt.exe"), "a<U+202E>txt.exe");  // right to left from here on
  EXPECT_EQ(printable("\u2066\u2069\u200f\u061c"), "<U+2066><U+2069><U+200F><U+061C>");
  EXPECT_EQ(printable("\ufeff\u2028"), "<U+FEFF><U+2028>");
  // The byte alone is CSI for a terminal of 8 bits.
  EXPECT_EQ(printable("\x9b\x33\xc3"), "<0x9B>3<0xC3>");
  EXPECT_EQ(printable(std::string_view("a\0b", 3)), "a<U+0000>b");
}

TEST(Printable, OfALongLineTheMiddleIsCounted) {
  EXPECT_EQ(printable("abcdefghij\nxyz", 8), "abcdef… (2 bytes) …ij\nxyz");
  EXPECT_EQ(printable("abcdefgh", 8), "abcdefgh");
  // Never inside of a character.
  EXPECT_EQ(printable("aaaaaσσσ", 8), "aaaaaσ… (2 bytes) …σ");
  EXPECT_EQ(printable("σσσσσσ", 4), "σσ… (8 bytes) …");
  EXPECT_LT(printable(std::string(5'000'000, 'x')).size(), 4100u);
}

TEST(Printable, NoBytesGiveAControlCharacter) {
  RandomStream random(5, "bytes");
  for (int round = 0; round < 2000; ++round) {
    std::string bytes;
    for (std::size_t i = random.index(20); i > 0; --i)
      bytes += static_cast<char>(random.index(256));
    const std::string shown = printable(bytes);
    for (std::string_view rest = shown; !rest.empty();) {
      const CodePoint point = first_code_point(rest);
      EXPECT_TRUE(point.valid);
      const bool is_control = point.value < 0x20 || (point.value >= 0x7F && point.value < 0xA0);
      EXPECT_TRUE(!is_control || point.value == '\n' || point.value == '\t') << point.value;
      rest.remove_prefix(point.bytes);
    }
  }
}

// What is offered for copying is one word for a shell, and for us.
TEST(ShellWord, IsTakenBackWhole) {
  for (const std::string word : {"a", "", "a b", "it's", "'", "\"", "$(x)", "a\\b", "`x`", "''a"}) {
    EXPECT_EQ(words_of_command("x " + shell_word(word)), (std::vector<std::string>{"x", word}));
    Program shell({"sh", "-c", "printf %s " + shell_word(word) + "; echo ."});
    EXPECT_EQ(shell.next_line(), word + ".");
  }
}

}  // namespace
}  // namespace fathom

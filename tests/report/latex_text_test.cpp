#include "src/report/latex_text.hpp"

#include <limits>
#include <string>

#include <gtest/gtest.h>

namespace fathom {
namespace {

TEST(LatexText, EscapesWhatLatexReadsAsItsOwn) {
  EXPECT_EQ(latex_text(R"(a_b & 50% #1 {x} $y$ \z ~ ^ < > |)"),
            "a\\_b \\& 50\\% \\#1 \\{x\\} \\$y\\$ \\textbackslash{}z \\textasciitilde{} "
            "\\textasciicircum{} \\textless{} \\textgreater{} \\textbar{}");
  EXPECT_EQ(latex_text("one\ntwo\tthree\x01"), "one two three ");
}

// Two hyphens would be a dash, two accents a quotation mark.
TEST(LatexText, BreaksLigatures) {
  EXPECT_EQ(latex_text("a-b --trials"), "a-b {-}-trials");
  EXPECT_EQ(latex_text("``q"), "{`}{`}q");
}

TEST(LatexText, WritesSignsThatPdflatexKnows) {
  EXPECT_EQ(latex_text("2σ χ² µm é ß"), "2$\\sigma$ $\\chi$$^2$ $\\mu$m é ß");
  EXPECT_EQ(latex_text("海"), "[U+6D77]");
  EXPECT_EQ(latex_text("🙂"), "[U+1F642]");
  EXPECT_EQ(latex_text("bad \xff\xc3"), "bad ??");
}

TEST(LatexText, NumbersHaveNoExponentLetter) {
  EXPECT_EQ(latex_number(5.01e-5, 3), "$5.01 \\times 10^{-5}$");
  EXPECT_EQ(latex_number(-1.2345e9, 3), "$-1.23 \\times 10^{9}$");
  EXPECT_EQ(latex_number(0.112, 3), "$0.112$");
  EXPECT_EQ(latex_number(0.0, 3), "$0$");
  EXPECT_EQ(latex_number(std::numeric_limits<double>::quiet_NaN(), 3), "--");
}

}  // namespace
}  // namespace fathom

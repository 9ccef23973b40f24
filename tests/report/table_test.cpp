#include "fathom/report/table.hpp"

#include <limits>
#include <optional>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.hpp"

namespace fathom {
namespace {

TEST(Table, AlignsTextLeftAndNumbersRight) {
  Table table({"estimator", "error (m)", "ANEES"});
  table.add_row({"trajectory_iekf", "0.08123", "1.02"});
  table.add_row({"ekf", "12.50", "-"});
  table.add_row({"", "5.8e+07", "nan"});
  EXPECT_EQ(table.text(),
            "estimator        error (m)  ANEES\n"
            "---------------  ---------  -----\n"
            "trajectory_iekf    0.08123   1.02\n"
            "ekf                  12.50      -\n"
            "                   5.8e+07    nan\n");
}

TEST(Table, OneWordMakesAColumnText) {
  Table table({"n", "x"});
  table.add_row({"1", "10"});
  table.add_row({"many", "2"});
  EXPECT_EQ(table.text(), "n      x\n----  --\n1     10\nmany   2\n");
}

TEST(Table, CountsCharactersNotBytes) {
  Table table({"σ (m)", "n"});
  table.add_row({"a", "1"});
  table.add_row({"日本語", "2"});
  EXPECT_EQ(table.text(), "σ (m)   n\n------  -\na       1\n日本語  2\n");
}

TEST(Table, WithoutRowsOrColumns) {
  EXPECT_EQ(Table({"a", "bb"}).text(), "a  bb\n-  --\n");
  EXPECT_EQ(Table({}).text(), "\n\n");
}

TEST(Table, RefusesARowOfAnotherLength) {
  Table table({"a", "b"});
  EXPECT_THAT(test::input_error_of([&] { table.add_row({"1"}); }),
              testing::HasSubstr("1 cells, not 2"));
}

TEST(DisplayWidth, OfUtf8) {
  EXPECT_EQ(display_width(""), 0U);
  EXPECT_EQ(display_width("abc"), 3U);
  EXPECT_EQ(display_width("χ²θ"), 3U);
  EXPECT_EQ(display_width("e\u0301"), 1U);  // a combining accent
  EXPECT_EQ(display_width("日本"), 4U);
  EXPECT_EQ(display_width("🤖"), 2U);
  EXPECT_EQ(display_width("\xff\x80"), 2U);   // no UTF-8
  EXPECT_EQ(display_width("a\xe6\x97"), 3U);  // cut inside a character
  EXPECT_EQ(display_width("\xe6"
                          "ab"),
            3U);
}

TEST(FormatNumber, SignificantDigits) {
  EXPECT_EQ(format_number(0.081, 4), "0.08100");
  EXPECT_EQ(format_number(12.3456, 4), "12.35");
  EXPECT_EQ(format_number(-12.3456, 4), "-12.35");
  EXPECT_EQ(format_number(12345.6, 4), "12346");
  EXPECT_EQ(format_number(9.9996, 4), "10.00");
  EXPECT_EQ(format_number(1, 1), "1");
  EXPECT_EQ(format_number(0.0001, 3), "0.000100");
  EXPECT_EQ(format_number(58265012, 4), "5.827e+07");
  EXPECT_EQ(format_number(9999999.7, 4), "1.000e+07");
  EXPECT_EQ(format_number(0.00001234, 2), "1.2e-05");
  EXPECT_EQ(format_number(0.0, 4), "0");
  EXPECT_EQ(format_number(-0.0, 4), "0");
  EXPECT_EQ(format_number(std::numeric_limits<double>::max(), 3), "1.80e+308");
}

TEST(FormatNumber, WhatIsNoNumber) {
  EXPECT_EQ(format_number(std::numeric_limits<double>::quiet_NaN(), 4), "nan");
  EXPECT_EQ(format_number(std::numeric_limits<double>::infinity(), 4), "inf");
  EXPECT_EQ(format_number(-std::numeric_limits<double>::infinity(), 4), "-inf");
  EXPECT_EQ(format_number(std::optional<double>(), 4), "-");
  EXPECT_EQ(format_number(std::optional<double>(2.5), 2), "2.5");
}

}  // namespace
}  // namespace fathom

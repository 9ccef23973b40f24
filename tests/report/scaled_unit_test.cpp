#include "src/report/scaled_unit.hpp"

#include <gtest/gtest.h>

namespace fathom {
namespace {

TEST(ScaledUnit, AValueReadsWithoutAnExponent) {
  EXPECT_EQ(quantity(4.01e-5, "m"), "0.0401 mm");
  EXPECT_EQ(quantity(0.0174, "m"), "17.4 mm");
  EXPECT_EQ(quantity(1.27, "m"), "1.27 m");
  EXPECT_EQ(quantity(1270.0, "m"), "1.27 km");
  EXPECT_EQ(quantity(-7.1e-7, "m"), "-0.710 µm");
  EXPECT_EQ(quantity(0.0414, "ms"), "0.0414 ms");
  EXPECT_EQ(quantity(0.0035, "ms"), "3.50 µs");
  EXPECT_EQ(quantity(2350.0, "ms"), "2.35 s");
  EXPECT_EQ(quantity(0.00196, "rad"), "1.96 mrad");
  EXPECT_EQ(quantity(238918.0, "bytes"), "239 kB");
  EXPECT_EQ(quantity(0.0, "m"), "0 m");
  EXPECT_EQ(quantity(176.0, ""), "176");
  EXPECT_EQ(quantity(5.01e-6, ""), "5.01 × 10⁻⁶");
}

TEST(ScaledUnit, AnIntervalHasTheUnitOfTheGreatest) {
  EXPECT_EQ(quantity(2.26e-6, Interval{-2.31e-5, 3.32e-5}, "m"), "0.00226 mm [-0.0231, 0.0332]");
  EXPECT_EQ(quantity(0.745, Interval{0.438, 1.0}, "m"), "0.745 m [0.438, 1.00]");
  EXPECT_EQ(quantity(1.7e6, Interval{-4.87e4, 9.17e6}, ""), "(1.70 [-0.0487, 9.17]) × 10⁶");
}

}  // namespace
}  // namespace fathom

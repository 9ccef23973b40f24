#pragma once

#include <gtest/gtest.h>

#include "fathom/vision/features.hpp"

namespace fathom::test {

inline void expect_same(const Features& a, const Features& b) {
  EXPECT_EQ(a.pixels, b.pixels);
  EXPECT_EQ(a.sizes_px, b.sizes_px);
  EXPECT_EQ(a.turns_rad, b.turns_rad);
  ASSERT_EQ(a.descriptors.size(), b.descriptors.size());
  ASSERT_EQ(a.descriptors.type(), b.descriptors.type());
  EXPECT_EQ(cv::countNonZero(a.descriptors != b.descriptors), 0);
}

}  // namespace fathom::test

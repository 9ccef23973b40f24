#include "fathom/report/palette.hpp"

#include <cmath>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

namespace fathom {
namespace {

TEST(Palette, AColourPerKnownNameAndAlwaysTheSame) {
  std::set<std::string> colours;
  for (const char* name :
       {"ground truth", "dead reckoning", "trajectory_iekf", "ekf", "ceres_pose_graph"}) {
    colours.insert(hex(series_colour(name)));
    EXPECT_EQ(series_colour(name), series_colour(std::string(name)));
  }
  EXPECT_EQ(colours.size(), 5U);
  EXPECT_EQ(hex(series_colour("trajectory_iekf")), "#0072b2");
  for (const char* name : {"", "gtsam", "isam2", "another", "ekf2"}) {
    EXPECT_FALSE(colours.contains(hex(series_colour(name)))) << name;
  }
}

// Luminance after WCAG 2: every line is told from white paper.
double luminance(Colour colour) {
  const auto linear = [](unsigned char channel) {
    const double s = channel / 255.0;
    return s <= 0.03928 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

TEST(Palette, EveryLineIsToldFromWhite) {
  for (const char* name : {"ground truth", "dead reckoning", "trajectory_iekf", "ekf",
                           "ceres_pose_graph", "a", "b", "c", "d", "e", "f"}) {
    EXPECT_GT(1.05 / (luminance(series_colour(name)) + 0.05), 2.0) << name;
  }
}

TEST(Palette, TintGoesToWhite) {
  EXPECT_EQ(tint(palette::blue, 1.0), palette::blue);
  EXPECT_EQ(tint(palette::blue, 0.0), palette::white);
  EXPECT_EQ(tint(palette::black, 0.5), (Colour{128, 128, 128}));
  EXPECT_EQ(hex(palette::white), "#ffffff");
}

}  // namespace
}  // namespace fathom

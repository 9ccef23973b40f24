#include "fathom/report/palette.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

namespace fathom {
namespace {

constexpr std::size_t kColours = kEstimatorColours;

TEST(Palette, EachPlaceHasALineAndAPointOfItsOwn) {
  std::set<std::string> colours;
  std::set<std::pair<std::string, std::vector<double>>> lines;
  std::set<std::pair<std::string, Mark>> points;
  for (std::size_t place = 0; place < 32; ++place) {
    const LineStyle style = estimator_style(place);
    EXPECT_EQ(style.dashes.empty(), place < kColours) << place;
    if (place < kColours) colours.insert(hex(style.colour));
    lines.insert({hex(style.colour), style.dashes});
    points.insert({hex(style.colour), style.mark});
    EXPECT_EQ(style, estimator_style(place));
    EXPECT_FALSE(style == ground_truth_style());
    EXPECT_FALSE(style == dead_reckoning_style());
  }
  EXPECT_EQ(colours.size(), kColours);
  EXPECT_EQ(lines.size(), 32U);
  EXPECT_EQ(points.size(), 32U);
  EXPECT_EQ(estimator_style(32), estimator_style(0));
  EXPECT_EQ(hex(estimator_style(0).colour), "#0072b2");
}

double linear(unsigned char channel) {
  const double s = channel / 255.0;
  return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

Eigen::Vector3d linear(Colour colour) {
  return {linear(colour.red), linear(colour.green), linear(colour.blue)};
}

// Contrast after WCAG 2: every line is told from white paper and from the page's dark card.
TEST(Palette, EveryLineIsToldFromItsGround) {
  const Eigen::Vector3d weights(0.2126, 0.7152, 0.0722);
  const double dark = weights.dot(linear(Colour{0x1d, 0x21, 0x25}));
  for (std::size_t place = 0; place < kColours; ++place) {
    const double luminance = weights.dot(linear(estimator_style(place).colour));
    EXPECT_GT(1.05 / (luminance + 0.05), 2.2) << place;
    EXPECT_GT((luminance + 0.05) / (dark + 0.05), 2.2) << place;
  }
}

Eigen::Vector3d lab(const Eigen::Vector3d& rgb) {
  Eigen::Matrix3d to_xyz;
  to_xyz << 0.4124, 0.3576, 0.1805, 0.2126, 0.7152, 0.0722, 0.0193, 0.1192, 0.9505;
  const Eigen::Vector3d xyz =
      (to_xyz * rgb).cwiseMax(0.0).cwiseQuotient(Eigen::Vector3d(0.9505, 1.0, 1.089));
  const auto f = [](double t) { return t > 0.008856 ? std::cbrt(t) : 7.787 * t + 16.0 / 116.0; };
  return {116.0 * f(xyz.y()) - 16.0, 500.0 * (f(xyz.x()) - f(xyz.y())),
          200.0 * (f(xyz.y()) - f(xyz.z()))};
}

// What protanopes and deuteranopes see, after Vienot, Brettel and Mollon (1999).
std::array<Eigen::Matrix3d, 3> visions() {
  Eigen::Matrix3d protan;
  protan << 0.11238, 0.88762, 0.0, 0.11238, 0.88762, 0.0, 0.00401, -0.00401, 1.0;
  Eigen::Matrix3d deutan;
  deutan << 0.29275, 0.70725, 0.0, 0.29275, 0.70725, 0.0, -0.02234, 0.02234, 1.0;
  return {Eigen::Matrix3d::Identity(), protan, deutan};
}

// CIE 1976 differences: 2.3 is just seen, and small patches ask for several times that.
TEST(Palette, ColoursAreToldApartByEveryCommonEye) {
  std::vector<Colour> colours{ground_truth_style().colour};
  for (std::size_t i = 0; i < kColours; ++i) colours.push_back(estimator_style(i).colour);
  for (const Eigen::Matrix3d& vision : visions()) {
    for (std::size_t i = 0; i < colours.size(); ++i) {
      for (std::size_t k = i + 1; k < colours.size(); ++k) {
        const Eigen::Vector3d a = lab(vision * linear(colours[i]));
        const Eigen::Vector3d b = lab(vision * linear(colours[k]));
        EXPECT_GT((a - b).norm(), 17.0) << hex(colours[i]) << " and " << hex(colours[k]);
      }
    }
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

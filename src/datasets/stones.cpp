#include "stones.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace fathom {
namespace {

constexpr double kTurn = 2.0 * std::numbers::pi;

struct Stone {
  double u_px = 0.0;
  double v_px = 0.0;
  double radius_px = 0.0;
  double flatness = 1.0;  ///< short over long axis
  double angle_rad = 0.0;
  double grey = 0.0;
  std::array<double, 3> lobes{};  ///< of the outline, two to four around
  std::array<double, 3> phases_rad{};

  // Distance from the middle as a share of the outline's there: 1 on the outline.
  double reach(double u, double v) const {
    const double c = std::cos(angle_rad);
    const double s = std::sin(angle_rad);
    const double along = c * u + s * v;
    const double across = (c * v - s * u) / flatness;
    const double around = std::atan2(across, along);
    double outline = radius_px;
    for (std::size_t k = 0; k < lobes.size(); ++k) {
      outline +=
          radius_px * lobes[k] * std::cos((static_cast<double>(k) + 2.0) * around + phases_rad[k]);
    }
    return std::hypot(along, across) / outline;
  }
};

// Radii follow a power law between two bounds: many small ones, few large.
Stone draw_stone(double smallest_px, double largest_px, RandomStream& stream) {
  constexpr double kExponent = -1.6;
  const double low = std::pow(smallest_px, kExponent);
  const double high = std::pow(largest_px, kExponent);
  Stone stone;
  stone.radius_px = std::pow(stream.uniform(high, low), 1.0 / kExponent);
  stone.flatness = stream.uniform(0.55, 1.0);
  stone.angle_rad = stream.uniform(0.0, kTurn);
  // Dark rock for the most part, some shells and quartz.
  stone.grey = stream.uniform() < 0.75 ? stream.uniform(45.0, 115.0) : stream.uniform(140.0, 225.0);
  for (double& lobe : stone.lobes) lobe = stream.uniform(0.0, 0.11);
  for (double& phase : stone.phases_rad) phase = stream.uniform(0.0, kTurn);
  return stone;
}

void blend(uchar& pixel, double grey, double share) {
  pixel = static_cast<uchar>(std::clamp(pixel + share * (grey - pixel), 0.0, 255.0));
}

// How much of a pixel lies inside an outline that is `reach` away; soft over `blur_px`.
double coverage(double reach, double radius_px, double blur_px) {
  return std::clamp(0.5 + (1.0 - reach) * radius_px / blur_px, 0.0, 1.0);
}

template <class Paint>
void for_pixels(cv::Mat& floor, double u, double v, double radius_px, Paint paint) {
  const auto first = [](double at) { return std::max(0, static_cast<int>(std::floor(at))); };
  const int bottom = std::min(floor.rows - 1, static_cast<int>(std::ceil(v + radius_px)));
  const int right = std::min(floor.cols - 1, static_cast<int>(std::ceil(u + radius_px)));
  for (int row = first(v - radius_px); row <= bottom; ++row) {
    uchar* pixels = floor.ptr(row);
    for (int column = first(u - radius_px); column <= right; ++column) {
      paint(pixels[column], column - u, row - v);
    }
  }
}

void paint(cv::Mat& floor, const Stone& stone) {
  const double radius = stone.radius_px;
  const double bounds = 1.4 * radius + 2.0;
  const double shift = 0.35 * radius;
  for_pixels(floor, stone.u_px + shift, stone.v_px + shift, bounds + shift,
             [&](uchar& pixel, double u, double v) {
               const double share = coverage(stone.reach(u, v), radius, 1.0 + 0.4 * radius);
               blend(pixel, 0.45 * pixel, share);
             });
  for_pixels(floor, stone.u_px, stone.v_px, bounds, [&](uchar& pixel, double u, double v) {
    const double reach = stone.reach(u, v);
    const double share = coverage(reach, radius, 1.2);
    if (share == 0.0) return;
    // A flattened dome, light from the upper left.
    const double slope = std::min(reach, 1.0) * std::min(reach, 1.0) / std::max(reach, 1e-3);
    const double light = 1.0 - 0.38 * slope * (u + v) / (radius * std::numbers::sqrt2);
    blend(pixel, stone.grey * light, share);
  });
}

struct Kind {
  double per_square_metre;
  double smallest_m;
  double largest_m;
  int heap;            ///< stones in each place
  double heap_size_m;  ///< standard deviation of their distance from it
};

void strew(cv::Mat& floor, double metres_per_pixel, const Kind& kind, RandomStream& stream) {
  // Below half a pixel a stone is grain.
  constexpr double kSmallestPx = 0.5;
  const double largest_px = kind.largest_m / metres_per_pixel;
  if (largest_px <= kSmallestPx) return;
  const double area_m2 = static_cast<double>(floor.total()) * metres_per_pixel * metres_per_pixel;
  const auto places = static_cast<std::size_t>(area_m2 * kind.per_square_metre);
  const double spread_px = kind.heap_size_m / metres_per_pixel;
  for (std::size_t i = 0; i < places; ++i) {
    const double u = stream.uniform(0.0, floor.cols);
    const double v = stream.uniform(0.0, floor.rows);
    for (int k = 0; k < kind.heap; ++k) {
      Stone stone = draw_stone(kind.smallest_m / metres_per_pixel, largest_px, stream);
      stone.u_px = u + spread_px * stream.normal();
      stone.v_px = v + spread_px * stream.normal();
      if (stone.radius_px > kSmallestPx) paint(floor, stone);
    }
  }
}

}  // namespace

void strew_stones(cv::Mat& floor, double metres_per_pixel, RandomStream& stream) {
  strew(floor, metres_per_pixel, {80.0, 0.003, 0.012, 1, 0.0}, stream);
  strew(floor, metres_per_pixel, {0.35, 0.004, 0.05, 40, 0.18}, stream);
  strew(floor, metres_per_pixel, {1.2, 0.012, 0.14, 1, 0.0}, stream);
}

}  // namespace fathom

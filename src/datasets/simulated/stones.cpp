#include "stones.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

#include <opencv2/core/utility.hpp>

namespace fathom {
namespace {

// Smaller than this a stone is grain.
constexpr double kSmallestPx = 0.5;

constexpr double kTurn = 2.0 * std::numbers::pi;

struct Stone {
  double u_px = 0.0;
  double v_px = 0.0;
  double radius_px = 0.0;
  double flatness = 1.0;  ///< short over long axis
  double cos = 1.0;       ///< of the long axis' angle
  double sin = 0.0;
  double grey = 0.0;
  std::array<double, 3> lobes{};  ///< of the outline, two to four around
  std::array<double, 3> phases_rad{};

  // Distance from the middle as a share of the outline's there: 1 on the outline. Where all of the
  // outline is nearer than `least` times that, just more than `least`.
  double reach(double u, double v, double least) const {
    const double along = cos * u + sin * v;
    const double across = (cos * v - sin * u) / flatness;
    const double far = 1.001 * least * (1.0 + lobes[0] + lobes[1] + lobes[2]) * radius_px;
    if (along * along + across * across > far * far) return 1.001 * least;
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
  const double angle_rad = stream.uniform(0.0, kTurn);
  stone.cos = std::cos(angle_rad);
  stone.sin = std::sin(angle_rad);
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

/// Some rows of a floor.
struct Rows {
  cv::Mat& floor;
  cv::Range range;
};

template <class Paint>
void for_pixels(const Rows& rows, double u, double v, double radius_px, Paint paint) {
  cv::Mat& floor = rows.floor;
  const auto first = [](double at) { return static_cast<int>(std::floor(at)); };
  const int bottom = std::min(rows.range.end - 1, static_cast<int>(std::ceil(v + radius_px)));
  const int right = std::min(floor.cols - 1, static_cast<int>(std::ceil(u + radius_px)));
  for (int row = std::max(rows.range.start, first(v - radius_px)); row <= bottom; ++row) {
    uchar* pixels = floor.ptr(row);
    for (int column = std::max(0, first(u - radius_px)); column <= right; ++column) {
      paint(pixels[column], column - u, row - v);
    }
  }
}

void paint(const Rows& rows, const Stone& stone) {
  const double radius = stone.radius_px;
  const double bounds = 1.4 * radius + 2.0;
  const double shift = 0.35 * radius;
  const double blur = 1.0 + 0.4 * radius;
  // From this reach on nothing is covered.
  const auto bare = [radius](double blur_px) { return 1.0 + 0.5 * blur_px / radius; };
  for_pixels(rows, stone.u_px + shift, stone.v_px + shift, bounds + shift,
             [&](uchar& pixel, double u, double v) {
               const double share = coverage(stone.reach(u, v, bare(blur)), radius, blur);
               blend(pixel, 0.45 * pixel, share);
             });
  for_pixels(rows, stone.u_px, stone.v_px, bounds, [&](uchar& pixel, double u, double v) {
    const double reach = stone.reach(u, v, bare(1.2));
    const double share = coverage(reach, radius, 1.2);
    if (share == 0.0) return;
    // A flattened dome, light from the upper left.
    const double slope = std::min(reach, 1.0) * std::min(reach, 1.0) / std::max(reach, 1e-3);
    const double light = 1.0 - 0.38 * slope * (u + v) / (radius * std::numbers::sqrt2);
    blend(pixel, stone.grey * light, share);
  });
}

struct Burrow {
  double u_px;
  double v_px;
  double radius_px;
};

// A hole in the middle of what was dug out of it: a low cone, lit from the upper left.
void paint(const Rows& rows, const Burrow& burrow) {
  const double cone_px = 3.0 * burrow.radius_px;
  for_pixels(
      rows, burrow.u_px, burrow.v_px, 1.3 * cone_px + 2.0, [&](uchar& pixel, double u, double v) {
        const double distance = std::hypot(u, v);
        const double share = coverage(distance / cone_px, cone_px, 0.5 * cone_px);
        const double towards_light = -(u + v) / (std::max(distance, 1e-3) * std::numbers::sqrt2);
        blend(pixel, pixel * (1.0 + 0.18 * towards_light), share);
        blend(pixel, 38.0, coverage(distance / burrow.radius_px, burrow.radius_px, 1.2));
      });
}

// In their order, as later ones cover earlier ones; some rows on each thread.
template <class Thing>
void paint_all(cv::Mat& floor, const std::vector<Thing>& things) {
  cv::parallel_for_({0, floor.rows}, [&](const cv::Range& range) {
    for (const Thing& thing : things) paint(Rows{floor, range}, thing);
  });
}

}  // namespace

void strew(cv::Mat& floor, double metres_per_pixel, const Stones& kind, RandomStream& stream) {
  const double largest_px = kind.largest_m / metres_per_pixel;
  if (largest_px <= kSmallestPx) return;
  const double area_m2 = static_cast<double>(floor.total()) * metres_per_pixel * metres_per_pixel;
  const auto places = static_cast<std::size_t>(area_m2 * kind.per_square_metre);
  const double spread_px = kind.heap_size_m / metres_per_pixel;
  std::vector<Stone> stones;
  for (std::size_t i = 0; i < places; ++i) {
    const double u = stream.uniform(0.0, floor.cols);
    const double v = stream.uniform(0.0, floor.rows);
    for (int k = 0; k < kind.heap; ++k) {
      Stone stone = draw_stone(kind.smallest_m / metres_per_pixel, largest_px, stream);
      stone.u_px = u + spread_px * stream.normal();
      stone.v_px = v + spread_px * stream.normal();
      if (stone.radius_px > kSmallestPx) stones.push_back(stone);
    }
  }
  paint_all(floor, stones);
}

void dig_burrows(cv::Mat& floor, double metres_per_pixel, RandomStream& stream) {
  constexpr double kPerSquareMetre = 7.0;
  constexpr double kLargestM = 0.014;
  if (kLargestM / metres_per_pixel <= kSmallestPx) return;
  const double area_m2 = static_cast<double>(floor.total()) * metres_per_pixel * metres_per_pixel;
  const auto count = static_cast<std::size_t>(area_m2 * kPerSquareMetre);
  std::vector<Burrow> burrows;
  for (std::size_t i = 0; i < count; ++i) {
    const double u = stream.uniform(0.0, floor.cols);
    const double v = stream.uniform(0.0, floor.rows);
    const double radius_px = stream.uniform(0.004, kLargestM) / metres_per_pixel;
    burrows.push_back({u, v, radius_px});
  }
  paint_all(floor, burrows);
}

}  // namespace fathom

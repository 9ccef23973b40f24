#include "sea_floor.hpp"

#include <memory>

#include "fathom/core/random.hpp"
#include "ground.hpp"
#include "stones.hpp"

namespace fathom {
namespace {

std::unique_ptr<Ground> ground_of(FloorKind kind, cv::Size size, double metres_per_pixel,
                                  RandomStream& stream) {
  switch (kind) {
    case FloorKind::ripples:
      return rippled_ground(size, metres_per_pixel, stream);
    case FloorKind::mud:
      return muddy_ground(size, metres_per_pixel, stream);
    case FloorKind::pebbles:
      return sandy_ground(size, metres_per_pixel, stream);
    case FloorKind::patches:
      return patchy_ground(size, metres_per_pixel, stream);
    case FloorKind::mixed:
      break;
  }
  return mixed_ground(size, metres_per_pixel, stream);
}

std::vector<Stones> stones_of(FloorKind kind) {
  switch (kind) {
    case FloorKind::ripples:
      return {{8.0, 0.003, 0.012, 1, 0.0}, {0.3, 0.012, 0.06, 1, 0.0}};
    case FloorKind::mud:
      return {{1.5, 0.004, 0.02, 1, 0.0}, {0.1, 0.012, 0.08, 1, 0.0}};
    case FloorKind::pebbles:
      return {
          {500.0, 0.007, 0.022, 1, 0.0}, {120.0, 0.015, 0.05, 1, 0.0}, {2.0, 0.04, 0.12, 1, 0.0}};
    case FloorKind::patches:
      return {
          {40.0, 0.003, 0.012, 1, 0.0}, {0.5, 0.006, 0.07, 70, 0.22}, {1.0, 0.012, 0.14, 1, 0.0}};
    case FloorKind::mixed:
      break;
  }
  return {{80.0, 0.003, 0.012, 1, 0.0}, {0.35, 0.004, 0.05, 40, 0.18}, {1.2, 0.012, 0.14, 1, 0.0}};
}

}  // namespace

const std::vector<std::pair<std::string, FloorKind>>& floor_kinds() {
  static const std::vector<std::pair<std::string, FloorKind>> kinds{
      {"mixed", FloorKind::mixed},
      {"ripples", FloorKind::ripples},
      {"mud", FloorKind::mud},
      {"pebbles", FloorKind::pebbles},
      {"patches", FloorKind::patches}};
  return kinds;
}

cv::Mat draw_sea_floor(cv::Size size, double metres_per_pixel, std::uint64_t seed, FloorKind kind) {
  RandomStream relief_stream(seed, "relief");
  RandomStream stone_stream(seed, "stones");
  const std::unique_ptr<Ground> ground = ground_of(kind, size, metres_per_pixel, relief_stream);
  cv::Mat picture(size, CV_8UC1);
  cv::parallel_for_(cv::Range(0, size.height),
                    [&](const cv::Range& rows) { ground->draw(picture, rows); });
  for (const Stones& stones : stones_of(kind)) {
    strew(picture, metres_per_pixel, stones, stone_stream);
  }
  if (kind == FloorKind::mud) dig_burrows(picture, metres_per_pixel, stone_stream);
  return picture;
}

}  // namespace fathom

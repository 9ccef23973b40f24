#include "floors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>

#include <opencv2/core.hpp>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "src/datasets/simulated/sea_floor.hpp"

namespace fathom::benchmarks {
namespace {

FloorKind kind_named(const std::string& name) {
  std::vector<std::string> names{"tiles"};
  for (const auto& [known, kind] : floor_kinds()) {
    if (known == name) return kind;
    names.push_back(known);
  }
  throw InputError("--floors: no floor '" + name + "'" + suggestion(name, names));
}

// A floor that repeats itself: tiles of 0.36 m, 90 pixels from 2 m, that all look alike but for a
// fifth of another floor over them.
cv::Mat draw_tiles(int side, double metres_per_pixel, std::uint64_t seed) {
  constexpr double kTileM = 0.36;
  constexpr double kOther = 0.2;
  const int tile_side = static_cast<int>(kTileM / metres_per_pixel);
  const cv::Mat tile = draw_sea_floor({tile_side, tile_side}, metres_per_pixel,
                                      stream_seed(seed, "tile", 0), FloorKind::mixed);
  const int count = side / tile_side + 1;
  cv::Mat tiles = cv::repeat(tile, count, count)(cv::Rect(0, 0, side, side));
  const cv::Mat other = draw_sea_floor({side, side}, metres_per_pixel, seed, FloorKind::mud);
  cv::Mat floor;
  cv::addWeighted(tiles, 1.0 - kOther, other, kOther, 0.0, floor);
  return floor;
}

Floor drawn_floor(const std::string& name, std::uint64_t seed) {
  constexpr double kSideM = 12.0;
  const double metres_per_pixel = floor_pixel_m(test::finest_pixel_of_pairs_m(Camera()));
  const int side = static_cast<int>(kSideM / metres_per_pixel);
  const std::uint64_t floor_seed = stream_seed(seed, "sea_floor", 0);
  const cv::Mat picture = name == "tiles" ? draw_tiles(side, metres_per_pixel, floor_seed)
                                          : draw_sea_floor({side, side}, metres_per_pixel,
                                                           floor_seed, kind_named(name));
  return {name, {picture, metres_per_pixel, {}}};
}

Floor read_floor(const std::string& given) {
  const std::size_t colon = given.rfind(':');
  const std::string file = given.substr(0, colon);
  const double metres_per_pixel =
      colon == std::string::npos ? 0.0 : std::strtod(given.c_str() + colon + 1, nullptr);
  if (!(metres_per_pixel > 0.0) || !std::isfinite(metres_per_pixel)) {
    throw InputError("--world: expected FILE:METRES_PER_PIXEL, got '" + given + "'");
  }
  return {std::filesystem::path(file).stem().string(),
          refined({decode_grey_picture(read_file(file), file), metres_per_pixel, {}},
                  test::finest_pixel_of_pairs_m(Camera()))};
}

}  // namespace

std::vector<std::string> floor_names(const Settings& settings) {
  std::vector<std::string> names = settings.floors;
  names.insert(names.end(), settings.worlds.begin(), settings.worlds.end());
  return names;
}

Floor make_floor(const Settings& settings, std::size_t i) {
  if (i < settings.floors.size()) return drawn_floor(settings.floors[i], settings.seed);
  return read_floor(settings.worlds[i - settings.floors.size()]);
}

FloorRenderer renderer_for(const Floor& floor, const test::Condition& condition,
                           std::uint64_t seed) {
  const Camera camera;
  World world = floor.world;
  if (condition.relief_share > 0.0) {
    world.relief = draw_relief(test::extent_of(world), condition.relief_m(),
                               stream_seed(seed, "sea_floor_relief", 0));
  }
  return {camera, ViewRays(camera), world};
}

}  // namespace fathom::benchmarks

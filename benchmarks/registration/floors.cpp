#include "floors.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "src/datasets/simulated/sea_floor.hpp"

namespace fathom::benchmarks {
namespace {

FloorKind kind_named(const std::string& name) {
  std::vector<std::string> names;
  for (const auto& [known, kind] : floor_kinds()) {
    if (known == name) return kind;
    names.push_back(known);
  }
  throw InputError("--floors: no floor '" + name + "'" + suggestion(name, names));
}

Floor drawn_floor(const std::string& name, std::uint64_t seed) {
  constexpr double kSideM = 12.0;
  const double metres_per_pixel = floor_pixel_m(test::finest_pixel_of_pairs_m(Camera()));
  const int side = static_cast<int>(kSideM / metres_per_pixel);
  const std::uint64_t floor_seed = stream_seed(seed, "sea_floor", 0);
  return {name,
          {draw_sea_floor({side, side}, metres_per_pixel, floor_seed, kind_named(name)),
           metres_per_pixel,
           {}}};
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

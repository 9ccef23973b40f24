#include "run_mosaics.hpp"

#include <fmt/format.h>

#include <opencv2/core/utility.hpp>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/system.hpp"
#include "fathom/report/geo_tiff.hpp"
#include "fathom/report/picture.hpp"
#include "fathom/report/table.hpp"
#include "fathom/report/world_file.hpp"
#include "map_files.hpp"

namespace fathom::workflow {
namespace {

/// Tiles of a GeoTIFF that is made tile by tile.
constexpr int kGeoTiffTile_px = 1024;

// A mosaic and where it goes.
struct PlannedMosaic {
  std::filesystem::path folder;
  MosaicPlan plan;
  bool is_north_up = false;  ///< of the GeoTIFF, on the grid of its projection
};

std::string world_file_of(const MosaicPlan& plan, const cv::Rect& window, const EarthFrame* earth) {
  return earth == nullptr ? world_file(plan, window) : world_file(plan, window, *earth);
}

MosaicFiles files_of(const EarthFrame* earth) {
  MosaicFiles files;
  if (earth != nullptr) files.world_file_epsg = earth->epsg();
  return files;
}

// `png`: the mosaic, encoded, unless it is north up.
void write(const PlannedMosaic& planned, const cv::Mat& mosaic, const std::string& png,
           const EarthFrame* earth) {
  if (planned.is_north_up) {
    write_geotiff(planned.folder / "mosaic.tif", *earth, planned.plan, mosaic);
  } else {
    const MosaicPlan& plan = planned.plan;
    write_file(planned.folder / "mosaic.png", png);
    write_file(planned.folder / "mosaic.pgw",
               world_file_of(plan, cv::Rect({0, 0}, plan.size), earth));
    write_file(planned.folder / "mosaic.json", mosaic_json(plan, files_of(earth)));
  }
}

// Every tile as a picture with its world file; returns their names.
std::vector<std::string> write_tiles(const std::filesystem::path& folder, const FrameSource& source,
                                     const MosaicPlan& plan, int tile_px, const EarthFrame* earth,
                                     Observer& observer) {
  std::filesystem::create_directory(folder / "tiles");
  std::vector<std::string> names;
  const auto take = [&](const MosaicTile& tile) {
    if (cv::countNonZero(tile.picture != kUnseen) == 0) return;
    const std::string name = fmt::format("tiles/r{}_c{}", tile.row, tile.column);
    write_file(folder / (name + ".png"), encode_png(tile.picture));
    write_file(folder / (name + ".pgw"), world_file_of(plan, tile.window, earth));
    names.push_back(name + ".png");
  };
  make_tiles(source, plan, {.side_px = tile_px}, take, observer.progress_of("mosaic, tile"));
  return names;
}

void write_tiled_geotiff(const std::filesystem::path& folder, const FrameSource& source,
                         const MosaicPlan& plan, const EarthFrame& earth, Observer& observer) {
  GeoTiff file(folder / "mosaic.tif", earth, plan, kGeoTiffTile_px);
  make_tiles(
      source, plan, {.side_px = kGeoTiffTile_px}, [&](const MosaicTile& tile) { file.write(tile); },
      observer.progress_of("mosaic.tif, tile"));
  file.finish();
}

// A picture of the survey is read once for all of them.
void make_and_write(const FrameSource& source, const std::vector<PlannedMosaic>& planned,
                    const EarthFrame* earth, Observer& observer) {
  std::vector<MosaicPlan> plans;
  plans.reserve(planned.size());
  for (const PlannedMosaic& one : planned) plans.push_back(one.plan);
  const std::vector<cv::Mat> made =
      make_mosaics(source, plans, observer.progress_of("mosaic, picture"));
  std::vector<std::string> pngs(made.size());
  cv::parallel_for_({0, static_cast<int>(made.size())}, [&](const cv::Range& range) {
    for (int k = range.start; k < range.end; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (!planned[i].is_north_up) pngs[i] = encode_png(made[i]);
    }
  });
  for (std::size_t i = 0; i < made.size(); ++i) write(planned[i], made[i], pngs[i], earth);
}

// The mosaic of a run, and north up on Earth; returns a line that says what they are.
std::string plan_both(const FrameSource& source, const RunMosaic& mosaic,
                      const MosaicOptions& options, const EarthFrame* earth,
                      std::vector<PlannedMosaic>& planned) {
  std::string line = "no mosaic: ";
  try {
    planned.push_back({mosaic.folder, plan_mosaic(source.camera(), mosaic.pictures, options)});
    line = "mosaic.png: " + mosaic_text(planned.back().plan);
    if (earth == nullptr) return line;
    const auto north_up = placed_on_grid(*earth, source.camera(), mosaic.pictures);
    planned.push_back({mosaic.folder, plan_mosaic(source.camera(), north_up, options), true});
    return line + "; mosaic.tif: " + earth->name();
  } catch (const InputError& error) {
    return (line.starts_with("no") ? line : line + "; no mosaic.tif: ") + error.what();
  }
}

}  // namespace

std::vector<PlacedPicture> placed_pictures(const Recording& recording,
                                           const std::vector<Pose>& keyframes) {
  std::vector<PlacedPicture> pictures;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    const FramePlace& place = recording.frames[i];
    const bool is_keyframe = place.time_ns == recording.keyframe_times_ns[place.keyframe];
    pictures.push_back({i, recording.frame_stances[i],
                        compose(keyframes[place.keyframe], place.motion_since_keyframe),
                        !is_keyframe});
  }
  return pictures;
}

std::vector<std::string> write_mosaics(const FrameSource& source,
                                       const std::vector<RunMosaic>& mosaics,
                                       const EarthFrame* earth, Observer& observer) {
  // Of solvers that are done: mosaics and the floor of a simulation need memory of their own.
  return_free_memory();
  MosaicOptions options;
  options.blend = MosaicBlend::seams;
  options.most_pixels /= static_cast<double>(mosaics.size()) * (earth == nullptr ? 1.0 : 2.0);
  std::vector<std::string> lines;
  lines.reserve(mosaics.size());
  std::vector<PlannedMosaic> planned;
  for (const RunMosaic& mosaic : mosaics) {
    lines.push_back(plan_both(source, mosaic, options, earth, planned));
  }
  make_and_write(source, planned, earth, observer);
  return lines;
}

std::string write_mosaic(const std::filesystem::path& folder, const FrameSource& source,
                         const std::vector<PlacedPicture>& pictures, const AskedMosaic& asked,
                         Observer& observer) {
  MosaicOptions options;
  options.metres_per_pixel = asked.metres_per_pixel;
  options.blend = asked.blend;
  if (asked.earth != nullptr) options.most_pixels /= 2.0;
  std::vector<PlannedMosaic> planned{
      {folder, plan_mosaic(source.camera(), pictures, options), false}};
  if (asked.earth != nullptr) {
    const auto north_up = placed_on_grid(*asked.earth, source.camera(), pictures);
    planned.push_back({folder, plan_mosaic(source.camera(), north_up, options), true});
  }
  make_and_write(source, planned, asked.earth, observer);
  return mosaic_text(planned.front().plan);
}

std::string write_tiled_mosaic(const std::filesystem::path& folder, const FrameSource& source,
                               const std::vector<PlacedPicture>& pictures, const AskedMosaic& asked,
                               int tile_px, Observer& observer) {
  MosaicOptions options = MosaicOptions::of_tiles();
  options.metres_per_pixel = asked.metres_per_pixel;
  options.blend = asked.blend;
  const MosaicPlan plan = plan_mosaic(source.camera(), pictures, options);
  MosaicFiles files = files_of(asked.earth);
  files.tile_px = tile_px;
  files.tiles = write_tiles(folder, source, plan, tile_px, asked.earth, observer);
  write_file(folder / "mosaic.json", mosaic_json(plan, files));
  if (asked.earth != nullptr) {
    const auto north_up = placed_on_grid(*asked.earth, source.camera(), pictures);
    write_tiled_geotiff(folder, source, plan_mosaic(source.camera(), north_up, options),
                        *asked.earth, observer);
  }
  return fmt::format("{} in {} tiles", mosaic_text(plan), files.tiles.size());
}

std::vector<std::string> mosaic_file_names() {
  return {"mosaic.json", "mosaic.pgw", "mosaic.png", "mosaic.tif", "tiles"};
}

std::string mosaic_text(const MosaicPlan& plan) {
  std::string text =
      fmt::format("{} pictures, {} x {} pixels of {} m", plan.pictures.size(), plan.size.width,
                  plan.size.height, format_number(plan.metres_per_pixel, 4));
  if (plan.metres_per_pixel > plan.wanted_metres_per_pixel) {
    text += "; of " + format_number(plan.wanted_metres_per_pixel, 4) + " m they would be too many";
  }
  return text;
}

}  // namespace fathom::workflow

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <utility>
#include <vector>

#include "blend.hpp"
#include "decoded_pictures.hpp"
#include "exposure.hpp"
#include "fathom/core/input_error.hpp"
#include "illumination.hpp"

namespace fathom {
namespace {

/// Some 150 bytes each, with their names in mosaic.json.
constexpr std::size_t kMostTiles = 400'000;
/// Over all tiles, the pictures in them.
constexpr std::size_t kMostUses = 4'000'000;

using PicturesByColumn = std::map<int, std::vector<const PlacedPicture*>>;

[[noreturn]] void throw_too_many(int side_px) {
  throw InputError(
      fmt::format("more than {} tiles of {} pixels a side, or {} pictures in them together; larger "
                  "tiles or pixels are fewer",
                  kMostTiles, side_px, kMostUses));
}

// Which pictures each tile needs, by row and column of tiles: tiles without one take no room.
std::map<int, PicturesByColumn> pictures_by_tile(const Camera& camera, const MosaicPlan& plan,
                                                 int side_px) {
  // In the order of frames, in which make_mosaics adds them up.
  std::vector<const PlacedPicture*> in_order;
  for (const PlacedPicture& place : plan.pictures) in_order.push_back(&place);
  std::ranges::stable_sort(in_order, {}, &PlacedPicture::frame);
  std::map<int, PicturesByColumn> tiles;
  std::size_t count = 0;
  std::size_t uses = 0;
  for (const PlacedPicture* place : in_order) {
    const cv::Rect box = Blend::box_of(camera, plan, *place);
    if (box.empty()) continue;
    for (int row = box.y / side_px; row <= (box.y + box.height - 1) / side_px; ++row) {
      for (int column = box.x / side_px; column <= (box.x + box.width - 1) / side_px; ++column) {
        std::vector<const PlacedPicture*>& tile = tiles[row][column];
        tile.push_back(place);
        if (tile.size() == 1) ++count;
        if (count > kMostTiles || ++uses > kMostUses) throw_too_many(side_px);
      }
    }
  }
  return tiles;
}

/// Makes one tile after the other.
class TileMaker {
 public:
  TileMaker(const FrameSource& source, const MosaicPlan& plan, const TileOptions& options)
      : source_(source),
        plan_(plan),
        side_px_(options.side_px),
        decoded_(source, options.cache_bytes),
        pictures_(decoded_, learnt_gain(source.camera(), decoded_, plan.pictures)) {
    if (plan.blend == MosaicBlend::feather) return;
    MosaicUses uses;
    for (const PlacedPicture& place : plan.pictures) uses[place.frame].push_back({0, &place});
    exposure_ = exposure_gains(source.camera(), uses, {&plan, 1}, pictures_).front();
  }

  MosaicTile tile(int row, int column, const std::vector<const PlacedPicture*>& pictures) {
    MosaicTile tile{row, column, {column * side_px_, row * side_px_, side_px_, side_px_}, {}};
    tile.window &= cv::Rect({0, 0}, plan_.size);
    Blend blend(source_.camera(), plan_, tile.window);
    std::vector<std::size_t> frames;
    frames.reserve(pictures.size());
    for (const PlacedPicture* place : pictures) frames.push_back(place->frame);
    auto next = pictures.begin();
    pictures_.for_each(frames, [&](std::size_t frame, const cv::Mat& picture) {
      blend.lay(picture, **next++, gain_of(frame));
    });
    tile.picture = blend.finish();
    return tile;
  }

 private:
  float gain_of(std::size_t frame) const {
    return plan_.blend == MosaicBlend::seams ? exposure_.at(frame) : 1.0F;
  }

  const FrameSource& source_;
  const MosaicPlan& plan_;
  int side_px_;
  DecodedPictures decoded_;
  LitPictures pictures_;
  ExposureGains exposure_;
};

}  // namespace

void make_tiles(const FrameSource& source, const MosaicPlan& plan, const TileOptions& options,
                const std::function<void(const MosaicTile&)>& take,
                const MosaicProgress& progress) {
  if (options.side_px < 1) throw InputError("a tile has one pixel a side at least");
  const auto rows = pictures_by_tile(source.camera(), plan, options.side_px);
  std::size_t count = 0;
  for (const auto& [row, columns] : rows) count += columns.size();
  TileMaker maker(source, plan, options);
  std::size_t done = 0;
  const auto make = [&](int row, const auto& entry) {
    take(maker.tile(row, entry.first, entry.second));
    if (progress) progress(++done, count);
  };
  // To and fro, so that a row begins with the pictures that the last one ended with.
  for (const auto& [row, columns] : rows) {
    if (row % 2 == 0) {
      for (auto at = columns.begin(); at != columns.end(); ++at) make(row, *at);
    } else {
      for (auto at = columns.rbegin(); at != columns.rend(); ++at) make(row, *at);
    }
  }
}

}  // namespace fathom

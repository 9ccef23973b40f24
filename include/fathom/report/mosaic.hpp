#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/datasets/frame_source.hpp"
#include "fathom/geometry/pose.hpp"

namespace fathom {

/// A picture of a survey and where it was taken, as a trajectory has it.
struct PlacedPicture {
  std::size_t frame = 0;
  Stance stance;
  Pose pose;  ///< of the body, in the world
  /// Laid only where the others leave a gap: a frame between keyframes, whose pose has the dead
  /// reckoning since the last one in it.
  bool is_filler = false;
};

/// What is shown where pictures overlap.
enum class MosaicBlend {
  feather,  ///< their mean, each weighted less towards its border: what is misplaced is seen twice
  seams     ///< details of that one whose middle is nearest, over light that fades from each to the
            ///< next, of pictures whose exposure is made equal
};

struct MosaicOptions {
  /// None: the median, over the pictures, of what a pixel covers.
  std::optional<double> metres_per_pixel;
  /// The largest mosaic. It takes 9 bytes a pixel while it is made, with seams 17.
  double most_pixels = 64e6;
  /// The longest side. Some viewers and readers of PNG files end at 2^16.
  double longest_px = 65'000.0;
  MosaicBlend blend = MosaicBlend::feather;

  /// Of a mosaic that is made tile by tile: neither memory nor a reader of pictures bounds it.
  static MosaicOptions of_tiles() { return {std::nullopt, 1e11, 1e9, MosaicBlend::feather}; }
};

/// Which pictures a mosaic is made of, and where its pixels lie: x up and y to the left.
struct MosaicPlan {
  std::vector<PlacedPicture> pictures;
  double metres_per_pixel = 0.0;
  double wanted_metres_per_pixel = 0.0;  ///< finer than the above where that would be too large
  /// The corner of the top left pixel, world: greatest x, greatest y. Whole pixels from the
  /// origin, so that mosaics of one resolution lie on one grid.
  Eigen::Vector2d top_left_m = Eigen::Vector2d::Zero();
  cv::Size size;
  MosaicBlend blend = MosaicBlend::feather;
};

/// Plans the mosaic of pictures that are given in the order of time. From the first one on a
/// picture is laid once a corner of its footprint is a third of the footprint's shorter side away
/// from where it was in the last one laid; the last is laid too, and the one before a leap, which
/// leaves less than a fifth of overlap. Fillers are laid by the same rule, but only where it is a
/// leap from the last one laid to the next that is no filler. So what can be covered is, the work
/// follows the way and not the frame rate, and a place is seen by a few pictures a leg, few enough
/// for a ghost to be seen. Where the mosaic would be larger than it may, its pixels are coarser; so
/// they are where a picture would cover more than 64 megapixels and four times its own.
///
/// Throws InputError without a picture, on a resolution or altitude that is not positive, on a pose
/// that is not finite, and where poses lie so far apart that the pictures would be specks.
MosaicPlan plan_mosaic(const Camera& camera, std::span<const PlacedPicture> pictures,
                       const MosaicOptions& options);

/// The grey level of what no picture shows; what one shows is 254 at most.
inline constexpr unsigned char kUnseen = 255;

/// Progress callback: pictures done, of how many; make_mosaics begins at none.
using MosaicProgress = std::function<void(std::size_t done, std::size_t of)>;

/// The mosaics, one each: 8-bit, one channel, of the plan's size. Pictures are flat-field
/// corrected: divided by the illumination that they have in common, as far as they show one, which
/// leaves their mean as it was. Each is projected by its camera, altitude, roll and pitch where
/// they are measured, and pose; where several overlap, they are blended as the plans say, the same
/// in all. Feathered, nothing is selected: what the trajectory places wrongly is seen twice, or
/// blurred. With seams its details end at one; each picture has been multiplied by the factor that
/// makes it agree with those it overlaps, and what light still differs fades. Nothing is aligned.
///
/// A picture that several mosaics need is read once, with seams twice but for those 256 MiB of them
/// that are kept. `source` must be that of the plans' camera. Throws InputError where a picture
/// cannot be read.
std::vector<cv::Mat> make_mosaics(const FrameSource& source, std::span<const MosaicPlan> plans,
                                  const MosaicProgress& progress = {});

/// A tile of a mosaic.
struct MosaicTile {
  int row = 0;  ///< of tiles, from the top
  int column = 0;
  cv::Rect window;  ///< its pixels in the whole mosaic; at the right and lower border it is cut
  cv::Mat picture;  ///< 8-bit, of the window's size
};

struct TileOptions {
  int side_px = 1024;
  /// Decoded pictures that are kept, as several tiles need each.
  std::size_t cache_bytes = std::size_t{256} << 20;
};

/// The mosaic tile by tile, row by row, the rows to and fro: those tiles alone that a picture may
/// reach. Put together they are that of make_mosaics bit for bit, whatever their size. Memory: a
/// tile at 9 bytes a pixel, with seams 17, the cache, 64 MiB of pictures in work, and some 200
/// bytes a picture, with seams 10 KB. Progress counts tiles. Throws InputError where a picture
/// cannot be read, and on more than 400 000 tiles or 4 000 000 pictures in them together.
void make_tiles(const FrameSource& source, const MosaicPlan& plan, const TileOptions& options,
                const std::function<void(const MosaicTile&)>& take,
                const MosaicProgress& progress = {});

/// What `mosaic.json` says of the files beside it.
struct MosaicFiles {
  std::optional<int> world_file_epsg;  ///< of the world files' coordinates; none: the map's
  std::optional<int> tile_px;          ///< the side of a tile; none: one picture
  std::vector<std::string> tiles;      ///< names of the tiles
};

/// The content of `mosaic.json`: where the pixels of a mosaic lie (docs/outputs.md).
std::string mosaic_json(const MosaicPlan& plan, const MosaicFiles& files = {});

}  // namespace fathom

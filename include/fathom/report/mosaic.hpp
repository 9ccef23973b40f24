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
  double altitude_m = 0.0;
  Pose pose;  ///< of the body, in the world
  /// Laid only where the others leave a gap: a frame between keyframes, whose pose has the dead
  /// reckoning since the last one in it.
  bool is_filler = false;
};

struct MosaicOptions {
  /// None: the median, over the pictures, of what a pixel covers.
  std::optional<double> metres_per_pixel;
  /// The largest mosaic. It takes 9 bytes a pixel while it is made.
  double most_pixels = 64e6;
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
};

/// Plans the mosaic of pictures that are given in the order of time. From the first one on a
/// picture is laid once a corner of its footprint is a third of the footprint's shorter side away
/// from where it was in the last one laid; the last is laid too, and the one before a leap, which
/// leaves less than a fifth of overlap. Fillers are laid by the same rule, but only where it is a
/// leap from the last one laid to the next that is no filler. So what can be covered is, the work
/// follows the way and not the frame rate, and a place is seen by a few pictures a leg, few enough
/// for a ghost to be seen. Where the mosaic would be larger than it may, its pixels are coarser.
///
/// Throws InputError without a picture, on a resolution or altitude that is not positive, on a pose
/// that is not finite, and where poses lie so far apart that the pictures would be specks.
MosaicPlan plan_mosaic(const Camera& camera, std::span<const PlacedPicture> pictures,
                       const MosaicOptions& options);

/// The grey level of what no picture shows; what one shows is 254 at most.
inline constexpr unsigned char kUnseen = 255;

/// Progress callback: pictures done, of how many.
using MosaicProgress = std::function<void(std::size_t done, std::size_t of)>;

/// The mosaics, one each: 8-bit, one channel, of the plan's size. Pictures are flat-field
/// corrected: divided by the illumination that they have in common, as far as they show one, which
/// leaves their mean as it was. Each is projected by its camera, altitude and pose; where several
/// overlap, they are feathered: averaged with weights that fall to zero towards the border of each.
/// Nothing is selected or aligned: what the trajectory places wrongly is seen twice, or blurred.
///
/// A picture that several mosaics need is read once, and one picture is held at a time.
/// `source` must be that of the plans' camera. Throws InputError where a picture cannot be read.
std::vector<cv::Mat> make_mosaics(const FrameSource& source, std::span<const MosaicPlan> plans,
                                  const MosaicProgress& progress = {});

/// The content of `mosaic.json`: where the pixels of a mosaic lie (docs/formats.md).
std::string mosaic_json(const MosaicPlan& plan);

}  // namespace fathom

#pragma once

#include <filesystem>
#include <optional>

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "fathom/report/mosaic.hpp"

namespace fathom {

/// A mosaic as a file has it: x up and y to the left.
struct MosaicRaster {
  cv::Mat grey;  ///< 8-bit; kUnseen where no picture shows a point
  double metres_per_pixel = 1.0;
  Eigen::Vector2d top_left_m = Eigen::Vector2d::Zero();  ///< the outer corner of the first pixel
  MosaicBlend blend = MosaicBlend::feather;

  /// A point of the map, (column, row) with 0 at the outer corner of the first pixel.
  Eigen::Vector2d pixel(const Eigen::Vector2d& map) const {
    return {(top_left_m.y() - map.y()) / metres_per_pixel,
            (top_left_m.x() - map.x()) / metres_per_pixel};
  }
};

/// The `mosaic.png` and `mosaic.json` of a run's folder. Nothing where one is missing, cannot be
/// read, or does not fit the other.
std::optional<MosaicRaster> read_mosaic(const std::filesystem::path& folder);

/// The same in coarser pixels, each the mean of the finer ones whose middles lie in it, if any of
/// these is seen. `metres_per_pixel` must be at least the mosaic's own, or none would be left for
/// some. `frame`: its pixels; corners at whole pixels from the origin.
MosaicRaster binned(const MosaicRaster& mosaic, double metres_per_pixel, const cv::Rect& frame);

/// The frame of whole pixels from the origin that holds the mosaic: columns run from +y to −y, rows
/// from +x to −x.
cv::Rect frame_of(const MosaicRaster& mosaic, double metres_per_pixel);

/// The mosaic in pixels as fine as a number of pixels allows, whole multiples of its own.
MosaicRaster shrunk(const MosaicRaster& mosaic, double most_pixels);

/// Two mosaics on one frame.
struct MosaicDifference {
  MosaicRaster frame;          ///< without grey levels: where the picture lies
  cv::Mat picture;             ///< BGR: a in orange, b in blue, grey where both are the same; pale
                               ///< where one alone shows the floor, white where none does
  double common_m2 = 0.0;      ///< area that both show
  double share_differs = 0.0;  ///< of that, where grey levels differ by more than kDiffers
};

/// Of 254 grey levels.
inline constexpr int kDiffers = 16;

MosaicDifference difference_of(const MosaicRaster& a, const MosaicRaster& b, double most_pixels);

}  // namespace fathom

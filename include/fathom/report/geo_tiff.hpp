#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "fathom/report/earth_frame.hpp"
#include "fathom/report/mosaic.hpp"

namespace fathom {

/// The pictures in the plane of the projection (EarthFrame::on_grid): turned by the convergence of
/// meridians and scaled by the projection, each at its own place, so that a mosaic of them is drawn
/// north up and no pixel is interpolated twice. Throws InputError where on_grid does.
std::vector<PlacedPicture> placed_on_grid(const EarthFrame& earth, const Camera& camera,
                                          std::span<const PlacedPicture> pictures);

/// A mosaic as GeoTIFF, north up: 8-bit grey in square tiles, 255 (kUnseen) is no data, deflate;
/// BigTIFF from 4 GB uncompressed on. Overviews by halves to 256 pixels, their pixels means of what
/// is seen, are further directories. Memory: five tiles. The file is whole only after `finish`.
class GeoTiff {
 public:
  /// `plan`: of pictures that were placed on the grid. `side_px` of its tiles must be a multiple of
  /// 16. Throws InputError where the file cannot be made.
  GeoTiff(const std::filesystem::path& path, const EarthFrame& earth, const MosaicPlan& plan,
          int side_px);
  ~GeoTiff();
  GeoTiff(const GeoTiff&) = delete;
  GeoTiff& operator=(const GeoTiff&) = delete;

  /// A tile of the plan's mosaic, of this side, in any order, each once. Throws InputError.
  void write(const MosaicTile& tile);

  /// What was not written is unseen. Writes the overviews. Throws InputError, on a full disk for
  /// example.
  void finish();

 private:
  struct File;
  std::unique_ptr<File> file_;
};

/// A mosaic that is whole.
void write_geotiff(const std::filesystem::path& path, const EarthFrame& earth,
                   const MosaicPlan& plan, const cv::Mat& mosaic);

}  // namespace fathom

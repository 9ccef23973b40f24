#include "fathom/report/geo_tiff.hpp"

namespace fathom {

std::vector<PlacedPicture> placed_on_grid(const EarthFrame& earth, const Camera& camera,
                                          std::span<const PlacedPicture> pictures) {
  // The projection stretches what the camera sees, but not the vehicle: the camera is what is
  // placed, and the body follows from its mounting.
  const CameraModel& model = camera.model();
  const Pose mount{model.mount_x_m, model.mount_y_m, 0.0};
  std::vector<PlacedPicture> placed(pictures.begin(), pictures.end());
  for (PlacedPicture& picture : placed) {
    const GridPose grid = earth.on_grid(compose(picture.pose, mount));
    picture.pose = compose(grid.pose, inverse(mount));
    picture.stance.altitude_m *= grid.scale;
  }
  return placed;
}

void write_geotiff(const std::filesystem::path& path, const EarthFrame& earth,
                   const MosaicPlan& plan, const cv::Mat& mosaic) {
  constexpr int kSide_px = 512;
  GeoTiff file(path, earth, plan, kSide_px);
  for (int row = 0; row * kSide_px < mosaic.rows; ++row) {
    for (int column = 0; column * kSide_px < mosaic.cols; ++column) {
      const cv::Rect window = cv::Rect(column * kSide_px, row * kSide_px, kSide_px, kSide_px) &
                              cv::Rect({0, 0}, mosaic.size());
      file.write({row, column, window, mosaic(window)});
    }
  }
  file.finish();
}

}  // namespace fathom

#pragma once

#include <cmath>
#include <filesystem>

#include "fathom/core/files.hpp"
#include "fathom/report/mosaic.hpp"
#include "fathom/report/picture.hpp"

namespace fathom::test {

/// What the page reads of an estimator's folder: a mosaic of 8 m by 6 m, x from −1 to 7 and y from
/// −3 to 3, grey 100 with a bright square of 1 m at (x, y). No picture shows x below 0. The track
/// goes by (0, 0), (4, 0) and (4, 2); of three loops one is used, one rejected, one of no keyframe.
inline void write_made_mosaic(const std::filesystem::path& folder, double x, double y,
                              double metres_per_pixel = 0.01,
                              MosaicBlend blend = MosaicBlend::feather) {
  MosaicPlan plan;
  plan.blend = blend;
  plan.metres_per_pixel = metres_per_pixel;
  plan.top_left_m = {7.0, 3.0};
  plan.size = cv::Size(static_cast<int>(std::lround(6.0 / metres_per_pixel)),
                       static_cast<int>(std::lround(8.0 / metres_per_pixel)));
  cv::Mat grey(plan.size, CV_8U, cv::Scalar(100));
  for (int v = 0; v < grey.rows; ++v) {
    for (int u = 0; u < grey.cols; ++u) {
      const double at_x = 7.0 - (v + 0.5) * metres_per_pixel;
      const double at_y = 3.0 - (u + 0.5) * metres_per_pixel;
      const bool is_bright = std::abs(at_x - x) < 0.5 && std::abs(at_y - y) < 0.5;
      if (is_bright) grey.at<unsigned char>(v, u) = 220;
      if (at_x < 0.0) grey.at<unsigned char>(v, u) = kUnseen;
    }
  }
  std::filesystem::create_directories(folder);
  write_file(folder / "mosaic.png", encode_png(grey));
  write_file(folder / "mosaic.json", mosaic_json(plan));
  write_file(folder / "trajectory.tum", "0 0 0 0 0 0 0 1\n1 4 0 0 0 0 0 1\n2 4 2 0 0 0 0 1\n");
  write_file(folder / "registrations.csv",
             "from,to,fate,nis,weight\n0,2,used,1,1\n0,1,rejected,1,0\n1,9,used,1,1\n");
}

}  // namespace fathom::test

#include "ground.hpp"

#include <utility>

namespace fathom {

void Ground::draw(cv::Mat& picture, const cv::Range& rows) const {
  const auto width = static_cast<std::size_t>(picture.cols);
  Row above_m(width);
  Row height_m(width);
  Row grey(width);
  Row slope_gain(width);
  heights(std::max(rows.start - 1, 0), above_m);
  for (int row = rows.start; row < rows.end; ++row) {
    heights(row, height_m);
    surface(row, grey, slope_gain);
    uchar* out = picture.ptr(row);
    for (std::size_t i = 0; i < width; ++i) {
      const float left_m = height_m[i > 0 ? i - 1 : 0];
      // Light from the upper left: slopes that face it are bright.
      const float slope =
          (2.0F * height_m[i] - left_m - above_m[i]) / static_cast<float>(metres_per_pixel_);
      const float light = 1.0F + slope_gain[i] * slope;
      out[i] = static_cast<uchar>(std::clamp(grey[i] * light, 0.0F, 255.0F));
    }
    std::swap(above_m, height_m);
  }
}

}  // namespace fathom

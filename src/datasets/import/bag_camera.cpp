#include "bag_camera.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

constexpr std::size_t kPlumbBob = 5;

void set_distortion(const CameraInfoMessage& info, CameraModel& model) {
  const auto is_zero = [](double number) { return number == 0.0; };
  if (std::ranges::all_of(info.D, is_zero)) return;
  const bool is_polynomial =
      info.distortion_model == "plumb_bob" || info.distortion_model == "rational_polynomial";
  const bool is_plain =
      info.D.size() <= kPlumbBob || std::all_of(info.D.begin() + kPlumbBob, info.D.end(), is_zero);
  if (!is_polynomial || !is_plain) {
    throw InputError("its distortion model " + in_quotes(info.distortion_model) +
                     " is not read; expected plumb_bob, or rectified pictures (image_rect of "
                     "image_proc)");
  }
  std::copy_n(info.D.begin(), std::min(info.D.size(), kPlumbBob), model.distortion.begin());
}

// A pixel of a picture that is cut out and binned: centres of pixels are at whole numbers.
double in_picture(double pixel, std::uint32_t offset, std::uint32_t binning) {
  const double cut = pixel - offset;
  return binning == 1 ? cut : (cut + 0.5) / binning - 0.5;
}

// Throws where a side of the pictures is not that of the region, binned; it may be cut to even.
void check_side(int side, std::uint32_t sensor, std::uint32_t region, std::uint32_t binning,
                const std::string& what) {
  constexpr std::int64_t kMostOff = 1;
  const std::uint32_t expected = (region > 0 ? region : sensor) / binning;
  if (expected == 0 || std::abs(std::int64_t{expected} - side) <= kMostOff) return;
  throw InputError("is of a " + what + " of " + std::to_string(expected) +
                   " pixels, the pictures have " + std::to_string(side) +
                   "; --camera FILE takes a sensor.yaml in its place");
}

}  // namespace

bool is_rectified(const std::string& image_topic) {
  return image_topic.find("/image_rect") != std::string::npos;
}

CameraModel camera_of(const CameraInfoMessage& info, const std::string& image_topic, int width,
                      int height) {
  CameraModel model;
  model.width = width;
  model.height = height;
  const std::uint32_t bin_x = std::max(info.binning_x, std::uint32_t{1});
  const std::uint32_t bin_y = std::max(info.binning_y, std::uint32_t{1});
  check_side(width, info.width, info.region_width, bin_x, "width");
  check_side(height, info.height, info.region_height, bin_y, "height");
  const bool rectified = is_rectified(image_topic);
  const double fx = rectified ? info.P[0] : info.K[0];
  const double fy = rectified ? info.P[5] : info.K[4];
  if (!(fx > 0.0 && fy > 0.0)) {
    throw InputError(std::string("the camera is not calibrated: the focal lengths in ") +
                     (rectified ? "P" : "K") +
                     " are not above zero; --camera FILE takes a sensor.yaml in its place");
  }
  model.fx = fx / bin_x;
  model.fy = fy / bin_y;
  model.cx = in_picture(rectified ? info.P[2] : info.K[2], info.x_offset, bin_x);
  model.cy = in_picture(rectified ? info.P[6] : info.K[5], info.y_offset, bin_y);
  if (!rectified) set_distortion(info, model);
  return model;
}

}  // namespace fathom

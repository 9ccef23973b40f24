#include "bag_camera.hpp"

#include <algorithm>
#include <cstdint>
#include <cstdlib>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

// The model behind a name of ROS; plumb_bob is what a rational polynomial without its last three
// numbers is.
std::optional<DistortionModel> lens_of(const std::string& name, std::size_t numbers) {
  const std::size_t most = entry_of(DistortionModel::radial_tangential).coefficients.size();
  if (name == "equidistant" || name == "fisheye") return DistortionModel::equidistant;
  if (name == "plumb_bob") return DistortionModel::radial_tangential;
  if (name != "rational_polynomial") return std::nullopt;
  return numbers <= most ? DistortionModel::radial_tangential
                         : DistortionModel::rational_polynomial;
}

void set_lens(const CameraInfoMessage& info, CameraModel& model) {
  const auto is_number = [](double number) { return number != 0.0; };
  // D without the zeros at its end, which say nothing.
  const auto end = std::find_if(info.D.rbegin(), info.D.rend(), is_number).base();
  const auto numbers = static_cast<std::size_t>(end - info.D.begin());
  const auto lens = lens_of(info.distortion_model, numbers);
  if (!lens && numbers == 0) return;
  if (!lens) {
    throw InputError("its distortion model " + in_quotes(info.distortion_model) +
                     " is not read; expected plumb_bob, rational_polynomial, equidistant or "
                     "fisheye, or rectified pictures (image_rect of image_proc)");
  }
  const std::vector<std::string>& coefficients = entry_of(*lens).coefficients;
  // A fisheye whose D is empty says nothing of its lens, which bends without coefficients, too.
  const bool is_short =
      *lens == DistortionModel::equidistant && info.D.size() < coefficients.size();
  if (is_short || numbers > coefficients.size()) {
    throw InputError("D of its distortion model " + in_quotes(info.distortion_model) + " has " +
                     counted(info.D.size(), "number") + "; expected " + entry_of(*lens).list());
  }
  model.distortion_model = *lens;
  std::copy(info.D.begin(), end, model.distortion.begin());
}

// A pixel of a picture that is cut out and binned: centres of pixels are at whole numbers.
double in_picture(double pixel, std::uint32_t offset, std::uint32_t binning) {
  const double cut = pixel - offset;
  return binning == 1 ? cut : (cut + 0.5) / binning - 0.5;
}

// Throws where a side of the pictures is not that of the region, binned; that may be cut to even.
void check_side(int side, std::uint32_t sensor, std::uint32_t region, std::uint32_t binning,
                const std::string& what) {
  const std::int64_t most_off = binning > 1 ? 1 : 0;
  const std::uint32_t expected = (region > 0 ? region : sensor) / binning;
  if (expected > 0 && std::abs(std::int64_t{expected} - side) <= most_off) return;
  throw InputError("is of a " + what + " of " + std::to_string(expected) +
                   " pixels, the pictures have " + std::to_string(side) +
                   "; --camera FILE takes a sensor.yaml in its place");
}

// What the pictures' camera is made of: the names of all that differs.
std::string changes(const CameraInfoMessage& was, const CameraInfoMessage& is, bool rectified) {
  const auto binning = [](const CameraInfoMessage& info) {
    return std::pair(std::max(info.binning_x, std::uint32_t{1}),
                     std::max(info.binning_y, std::uint32_t{1}));
  };
  const auto region = [](const CameraInfoMessage& info) {
    return std::tuple(info.x_offset, info.y_offset, info.region_width, info.region_height);
  };
  std::vector<std::string> names;
  if (was.width != is.width || was.height != is.height) names.emplace_back("size");
  if (binning(was) != binning(is)) names.emplace_back("binning");
  if (region(was) != region(is)) names.emplace_back("region of interest");
  if (rectified && was.P != is.P) names.emplace_back("P");
  if (!rectified && was.K != is.K) names.emplace_back("K");
  if (!rectified && was.D != is.D) names.emplace_back("D");
  if (!rectified && was.distortion_model != is.distortion_model) {
    names.emplace_back("distortion_model");
  }
  return joined(names, ", ");
}

}  // namespace

bool BagCameraInfo::is_empty(const CameraInfoMessage& info) const {
  const bool has_focal_length =
      rectified_ ? info.P[0] > 0.0 && info.P[5] > 0.0 : info.K[0] > 0.0 && info.K[4] > 0.0;
  return !has_focal_length || info.width == 0 || info.height == 0;
}

void BagCameraInfo::take(const CameraInfoMessage& info, std::int64_t record_ns) {
  const bool has_camera = info_ && !is_empty(*info_);
  if (is_empty(info)) ++empty_;
  if (!has_camera) info_ = info;
  if (!has_camera || is_empty(info)) return;
  const std::string changed = changes(*info_, info, rectified_);
  if (changed.empty()) return;
  const std::int64_t time_ns = info.stamp_ns != 0 ? info.stamp_ns : record_ns;
  throw InputError("the camera changes at " + seconds_text(time_ns) + " s: " + changed +
                   "; expected one for all pictures: cut the bag there, or --camera FILE takes a "
                   "sensor.yaml for all of them");
}

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
  if (info.width == 0 || info.height == 0) {
    throw InputError("is of " + std::to_string(info.width) + " x " + std::to_string(info.height) +
                     " pixels; --camera FILE takes a sensor.yaml in its place");
  }
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
  if (!rectified) set_lens(info, model);
  return model;
}

}  // namespace fathom

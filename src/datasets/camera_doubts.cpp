#include "fathom/datasets/camera_doubts.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/text.hpp"

namespace fathom {

// A calibration tells the principal point to a few per cent of the picture.
bool principal_point_looks_exchanged(const CameraModel& camera) {
  constexpr double kNear = 0.1;
  const double near_px = kNear * std::min(camera.width, camera.height);
  const double middle_x = 0.5 * (camera.width - 1);
  const double middle_y = 0.5 * (camera.height - 1);
  return std::hypot(camera.cx - middle_x, camera.cy - middle_y) > near_px &&
         std::hypot(camera.cx - middle_y, camera.cy - middle_x) < near_px;
}

std::vector<std::string> camera_doubts(const CameraModel& camera, const std::string& where) {
  constexpr double kMostDifference = 0.05;
  constexpr int kDigits = 6;
  constexpr double kPercent = 100.0;
  const auto number = [](double value) { return short_number(value, kDigits); };
  std::vector<std::string> doubts;
  const double difference = std::abs(camera.fx - camera.fy) / (0.5 * camera.fx + 0.5 * camera.fy);
  if (difference > kMostDifference) {
    doubts.push_back(fmt::format(
        "{}: fx {} and fy {} differ by {:.0f} %; pixels are square in nearly all cameras: are the "
        "numbers in another order than fx, fy, cx, cy, or the pictures stretched?",
        where, number(camera.fx), number(camera.fy), kPercent * difference));
  }
  if (principal_point_looks_exchanged(camera)) {
    doubts.push_back(fmt::format(
        "{}: cx {} and cy {} look exchanged in pictures of {} x {}; write cx {} and cy {}, unless "
        "the pictures are a part that was cut out",
        where, number(camera.cx), number(camera.cy), camera.width, camera.height, number(camera.cy),
        number(camera.cx)));
  }
  return doubts;
}

}  // namespace fathom

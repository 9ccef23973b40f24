#include "illumination.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include "flat_field.hpp"

namespace fathom {
namespace {

/// Pictures that the illumination is learnt from.
constexpr std::size_t kMostSamples = 40;

// Pictures whose middles lie further apart than the shorter side of a footprint show another piece
// of floor each.
double independent_count(const Camera& camera, const std::vector<PlacedPicture>& pictures) {
  const CameraModel& model = camera.model();
  const Eigen::Vector2d middle_px(0.5 * (model.width - 1), 0.5 * (model.height - 1));
  std::vector<Eigen::Vector2d> apart;
  for (const PlacedPicture& picture : pictures) {
    const auto corners = camera.footprint(picture.stance);
    const double side_m =
        std::min((corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm());
    const Eigen::Vector2d middle =
        transform(picture.pose, camera.floor_point(middle_px, picture.stance));
    const bool is_new = std::ranges::all_of(
        apart, [&](const Eigen::Vector2d& other) { return (middle - other).norm() >= side_m; });
    if (is_new) apart.push_back(middle);
  }
  return static_cast<double>(apart.size());
}

}  // namespace

cv::Mat learnt_gain(const Camera& camera, DecodedPictures& decoded,
                    const std::vector<PlacedPicture>& pictures) {
  std::vector<PlacedPicture> samples;
  std::vector<std::size_t> frames;
  const std::size_t count = std::min(pictures.size(), kMostSamples);
  for (std::size_t i = 0; i < count; ++i) {
    samples.push_back(pictures[i * pictures.size() / count]);
    frames.push_back(samples.back().frame);
  }
  const CameraModel& model = camera.model();
  FlatField field(cv::Size(model.width, model.height));
  for (std::size_t i = 0; i < count; ++i) {
    decoded.prepare(std::span(frames).subspan(i));
    field.add(decoded.picture(frames[i]));
  }
  return field.gain(independent_count(camera, samples));
}

cv::Mat lit_evenly(const cv::Mat& picture, const cv::Mat& gain) {
  cv::Mat even;
  picture.convertTo(even, CV_32F);
  cv::multiply(even, gain, even);
  return even;
}

}  // namespace fathom

#include "illumination.hpp"

#include <algorithm>
#include <cstddef>
#include <span>

#include <opencv2/core/utility.hpp>

#include "flat_field.hpp"

namespace fathom {
namespace {

/// Pictures that the illumination is learnt from.
constexpr std::size_t kMostSamples = 40;

/// Of CV_32F pictures that are made side by side.
constexpr std::size_t kMostBytes = std::size_t{64} << 20;

std::size_t side_by_side(std::size_t pixels) {
  const auto threads = static_cast<std::size_t>(std::max(1, cv::getNumThreads()));
  const std::size_t room = kMostBytes / (sizeof(float) * std::max<std::size_t>(1, pixels));
  return std::clamp<std::size_t>(room, 1, threads);
}

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
  const std::size_t at_once =
      side_by_side(static_cast<std::size_t>(model.width) * static_cast<std::size_t>(model.height));
  for (std::size_t i = 0; i < count; i += at_once) {
    field.add(decoded.first_of(std::span(frames).subspan(i), at_once));
  }
  return field.gain(independent_count(camera, samples));
}

void LitPictures::for_each(std::span<const std::size_t> frames, const Use& take,
                           const Use& beside) {
  lit_.resize(side_by_side(gain_.total()));
  for (std::size_t i = 0; i < frames.size(); i += lit_.size()) {
    const std::vector<cv::Mat> pictures = decoded_.first_of(frames.subspan(i), lit_.size());
    cv::parallel_for_({0, static_cast<int>(pictures.size())}, [&](const cv::Range& range) {
      for (int k = range.start; k < range.end; ++k) {
        const auto place = static_cast<std::size_t>(k);
        cv::multiply(pictures[place], gain_, lit_[place], 1.0, CV_32F);
        if (beside) beside(frames[i + place], lit_[place]);
      }
    });
    for (std::size_t k = 0; k < pictures.size(); ++k) take(frames[i + k], lit_[k]);
  }
}

}  // namespace fathom

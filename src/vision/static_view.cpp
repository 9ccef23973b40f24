#include "fathom/vision/static_view.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include <opencv2/imgproc.hpp>

#include "fathom/core/text.hpp"
#include "flatten.hpp"

namespace fathom {
namespace {

// Zero-mean, of deviation 1 where there is texture.
cv::Mat as_numbers(const cv::Mat& detail, const FeatureTuning& tuning) {
  cv::Mat numbers;
  detail.convertTo(numbers, CV_32F, 1.0 / tuning.deviation, -tuning.mean / tuning.deviation);
  return numbers;
}

// Every fourth pixel each way does: what is compared is a whole picture.
cv::Mat sampled(const cv::Mat& numbers) {
  cv::Mat samples;
  cv::resize(numbers, samples, {}, 0.25, 0.25, cv::INTER_NEAREST);
  return samples;
}

double agreement(const cv::Mat& a, const cv::Mat& b) {
  const double energy = a.dot(a) * b.dot(b);
  return energy > 0.0 ? a.dot(b) / std::sqrt(energy) : 0.0;
}

// Of pictures of one place, as of a vehicle at rest, the first alone.
std::vector<cv::Mat> of_different_places(std::span<const cv::Mat> details, double most_agreement) {
  std::vector<cv::Mat> kept;
  std::vector<cv::Mat> samples;
  for (const cv::Mat& detail : details) {
    const cv::Mat numbers = as_numbers(detail, {});
    const cv::Mat sample = sampled(numbers);
    const bool is_alike = std::ranges::any_of(
        samples, [&](const cv::Mat& other) { return agreement(sample, other) > most_agreement; });
    if (is_alike) continue;
    kept.push_back(numbers);
    samples.push_back(sample);
  }
  return kept;
}

struct Correlation {
  cv::Mat at;      ///< by pixel
  cv::Mat energy;  ///< Σ d_i² about it
};

Correlation correlation_of(const std::vector<cv::Mat>& pictures, const StaticViewOptions& options) {
  cv::Mat sum = cv::Mat::zeros(pictures.front().size(), CV_32F);
  cv::Mat squares = sum.clone();
  for (const cv::Mat& picture : pictures) {
    sum += picture;
    squares += picture.mul(picture);
  }
  const int side = 2 * options.correlation_px + 1;
  cv::Mat common;
  Correlation result;
  cv::boxFilter(sum.mul(sum) - squares, common, -1, {side, side});
  cv::boxFilter(squares, result.energy, -1, {side, side});
  // What has no texture in any picture agrees with nothing.
  constexpr double kLeastEnergy = 0.02;
  const auto others = static_cast<double>(pictures.size() - 1);
  result.at = common / cv::max(others * result.energy, others * kLeastEnergy);
  return result;
}

double mean_where(const Correlation& correlation, const cv::Mat& mask) {
  const double energy = cv::mean(correlation.energy, mask)[0];
  const double common = cv::mean(correlation.at.mul(correlation.energy), mask)[0];
  return energy > 0.0 ? common / energy : 0.0;
}

// Without specks, with the gaps between letters closed, and without small parts.
cv::Mat cleaned(const cv::Mat& is_static, const StaticViewOptions& options) {
  const auto square = [](int side_px) {
    return cv::getStructuringElement(cv::MORPH_RECT, {side_px, side_px});
  };
  cv::Mat parts;
  cv::morphologyEx(is_static, parts, cv::MORPH_OPEN, square(options.speck_px));
  cv::morphologyEx(parts, parts, cv::MORPH_CLOSE, square(options.gap_px));
  cv::Mat labels;
  cv::Mat numbers;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(parts, labels, numbers, centres);
  for (int part = 1; part < count; ++part) {
    if (numbers.at<int>(part, cv::CC_STAT_AREA) < options.least_area) {
      parts.setTo(0, labels == part);
    }
  }
  return parts;
}

double share_of(const cv::Mat& picture) {
  return static_cast<double>(cv::countNonZero(picture)) / static_cast<double>(picture.total());
}

constexpr std::array<const char*, 4> kSides{"lowest", "uppermost", "leftmost", "rightmost"};

// How much of the picture lies between each side and the far end of a part.
std::array<double, 4> depths(const cv::Rect& part, cv::Size size) {
  const auto of = [](int length_px, int all_px) {
    return static_cast<double>(length_px) / static_cast<double>(all_px);
  };
  return {of(size.height - part.y, size.height), of(part.y + part.height, size.height),
          of(part.x + part.width, size.width), of(size.width - part.x, size.width)};
}

}  // namespace

cv::Mat detail_of_view(const cv::Mat& gray, const StaticViewOptions& options) {
  FeatureTuning tuning;
  tuning.window_px = options.window_px;
  tuning.least_deviation = options.least_deviation;
  const int longest_px = std::max(gray.cols, gray.rows);
  const int factor =
      std::max(1, cvRound(longest_px / static_cast<double>(options.longest_side_px)));
  if (factor == 1) return flattened(gray, tuning);
  cv::Mat reduced;
  cv::resize(gray, reduced, {gray.cols / factor, gray.rows / factor}, 0, 0, cv::INTER_AREA);
  return flattened(reduced, tuning);
}

bool may_have_static_view(std::span<const cv::Mat> details, const StaticViewOptions& options) {
  const auto pictures = of_different_places(details, options.most_agreement);
  if (pictures.size() < details.size()) return true;
  if (pictures.size() < static_cast<std::size_t>(options.least_pictures)) return true;
  const Correlation correlation = correlation_of(pictures, options);
  return cv::countNonZero(cleaned(correlation.at > options.possible_correlation, options)) > 0;
}

StaticView find_static_view(std::span<const cv::Mat> details, cv::Size size,
                            const StaticViewOptions& options) {
  const auto pictures = of_different_places(details, options.most_agreement);
  if (pictures.size() < static_cast<std::size_t>(options.least_pictures)) return {{}, false};
  const Correlation correlation = correlation_of(pictures, options);
  const cv::Mat found = cleaned(correlation.at > options.least_correlation, options);
  if (cv::countNonZero(found) == 0) return {};
  if (share_of(found) > options.most_agreement ||
      mean_where(correlation, found == 0) > options.most_correlation_elsewhere) {
    return {{}, false};
  }
  StaticView view;
  cv::resize(found == 0, view.mask, size, 0, 0, cv::INTER_NEAREST);
  return view;
}

double masked_share(const cv::Mat& mask) {
  return mask.empty() ? 0.0 : share_of(mask == 0);
}

std::string masked_where(const cv::Mat& mask) {
  constexpr double kMostOfASide = 1.0 / 3.0;
  constexpr double kLeastOfASide = 0.01;  // of the picture's area
  cv::Mat labels;
  cv::Mat numbers;
  cv::Mat centres;
  const int count = cv::connectedComponentsWithStats(mask == 0, labels, numbers, centres);
  std::array<double, 4> at_sides{};
  std::size_t others = 0;
  for (int part = 1; part < count; ++part) {
    const int* const row = numbers.ptr<int>(part);
    const auto depth = depths({row[cv::CC_STAT_LEFT], row[cv::CC_STAT_TOP], row[cv::CC_STAT_WIDTH],
                               row[cv::CC_STAT_HEIGHT]},
                              mask.size());
    const auto nearest = std::ranges::min_element(depth);
    const double area = row[cv::CC_STAT_AREA] / static_cast<double>(mask.total());
    if (*nearest > kMostOfASide || area < kLeastOfASide) {
      ++others;
      continue;
    }
    double& side = at_sides[static_cast<std::size_t>(nearest - depth.begin())];
    side = std::max(side, *nearest);
  }
  std::vector<std::string> places;
  for (std::size_t side = 0; side < at_sides.size(); ++side) {
    if (at_sides[side] > 0.0) {
      places.push_back(fmt::format("the {} {:.0f} %", kSides[side], 100.0 * at_sides[side]));
    }
  }
  if (others > 0) places.push_back(counted(others, places.empty() ? "part" : "other part"));
  return joined(places, ", ");
}

}  // namespace fathom

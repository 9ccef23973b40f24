#include "flatten.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

namespace fathom {
namespace {

// Twice a box, near enough a Gaussian of this radius, at a cost that does not grow with it.
cv::Mat smoothed(const cv::Mat& picture, int radius_px) {
  const cv::Size box(2 * radius_px + 1, 2 * radius_px + 1);
  cv::Mat once;
  cv::Mat twice;
  cv::boxFilter(picture, once, CV_32F, box, {-1, -1}, true, cv::BORDER_REFLECT_101);
  cv::boxFilter(once, twice, CV_32F, box, {-1, -1}, true, cv::BORDER_REFLECT_101);
  return twice;
}

double deviation_of(const cv::Mat& picture) {
  cv::Scalar mean;
  cv::Scalar deviation;
  cv::meanStdDev(picture, mean, deviation);
  return deviation[0];
}

cv::Mat blurred(const cv::Mat& picture, double sigma_px) {
  cv::Mat result;
  cv::GaussianBlur(picture, result, {}, sigma_px);
  return result;
}

// The blur that leaves less of a sensor's noise than there is of the floor, 0 where that is so
// already. Noise is told by the scale: it is strongest from pixel to pixel, where a floor seen
// through a lens has little, no more than in the band of 1 to 2 pixels.
double blur_for_noise(const cv::Mat& picture, const FeatureTuning& tuning) {
  const auto square = [](double x) { return x * x; };
  const double fine = square(deviation_of(picture - blurred(picture, tuning.fine_blur_px)));
  const double middle = square(deviation_of(blurred(picture, tuning.middle_blur_px) -
                                            blurred(picture, tuning.coarse_blur_px)));
  const double ratio = tuning.floor_band_ratio;
  const double noise =
      std::sqrt(std::max(0.0, fine - square(ratio) * middle) /
                (square(tuning.noise_in_fine_band) - square(ratio * tuning.noise_in_middle_band)));
  const double floor =
      std::sqrt(std::max(0.0, middle - square(tuning.noise_in_middle_band * noise)));
  // A Gaussian blur of sigma leaves 1 / (2 √π sigma) of the noise.
  const double sigma = noise / (2.0 * std::sqrt(std::numbers::pi) * tuning.noise_left *
                                std::max(floor, tuning.least_floor));
  return sigma < tuning.least_blur_px ? 0.0 : std::min(sigma, tuning.most_blur_px);
}

}  // namespace

cv::Mat flattened(const cv::Mat& gray, const FeatureTuning& tuning) {
  cv::Mat detail;
  gray.convertTo(detail, CV_32F);
  const double blur_px = blur_for_noise(detail, tuning);
  if (blur_px > 0.0) detail = blurred(detail, blur_px);
  const int radius_px = cvRound(tuning.window_px + tuning.window_growth * blur_px);
  detail -= smoothed(detail, radius_px);
  cv::Mat deviation;
  cv::sqrt(smoothed(detail.mul(detail), radius_px), deviation);
  detail /= deviation + tuning.least_deviation;
  cv::Mat flat;
  detail.convertTo(flat, CV_8U, tuning.deviation, tuning.mean);
  return flat;
}

}  // namespace fathom

#include "contenders.hpp"

#include <algorithm>
#include <cmath>

#include <opencv2/calib3d.hpp>
#include <opencv2/features2d.hpp>

namespace fathom::benchmarks {
namespace {

struct PointPairs {
  std::vector<cv::Point2f> p;
  std::vector<cv::Point2f> q;
};

PointPairs nearest_by_ratio(const FloorFeatures& from, const FloorFeatures& to, double ratio,
                            double metres_per_pixel) {
  PointPairs pairs;
  if (from.size() == 0 || to.size() < 2) return pairs;
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_L2)
      .knnMatch(from.features.descriptors, to.features.descriptors, nearest, 2);
  const auto in_pixels = [metres_per_pixel](const Eigen::Vector2d& point) {
    return cv::Point2f(static_cast<float>(point.x() / metres_per_pixel),
                       static_cast<float>(point.y() / metres_per_pixel));
  };
  for (const std::vector<cv::DMatch>& two : nearest) {
    if (two.size() < 2 || !(two[0].distance < ratio * two[1].distance)) continue;
    pairs.p.push_back(in_pixels(from.points[static_cast<std::size_t>(two[0].queryIdx)]));
    pairs.q.push_back(in_pixels(to.points[static_cast<std::size_t>(two[0].trainIdx)]));
  }
  return pairs;
}

}  // namespace

Answer ours(const FloorFeatures& from, const FloorFeatures& to, const RegistrationOptions& options,
            std::uint64_t seed, bool split_time) {
  Answer answer;
  if (split_time) {
    const Stopwatch watch;
    match(from.features, to.features, options.matching);
    answer.match_ms = watch.milliseconds();
  }
  const Stopwatch watch;
  const Registration registration = register_pair(from, to, options, seed);
  answer.solve_ms = std::max(0.0, watch.milliseconds() - answer.match_ms);
  answer.false_alarms = registration.evidence.false_alarms;
  if (!registration.found) return answer;
  answer.motion = registration.motion;
  answer.covariance = registration.covariance;
  return answer;
}

Answer opencv(const FloorFeatures& from, const FloorFeatures& to,
              const RegistrationOptions& options, double metres_per_pixel) {
  Answer answer;
  const Stopwatch match_watch;
  const PointPairs pairs = nearest_by_ratio(from, to, options.matching.ratio, metres_per_pixel);
  answer.match_ms = match_watch.milliseconds();
  const Stopwatch solve_watch;
  if (pairs.p.size() < 2) return answer;
  cv::Mat inliers;
  const double max_error_m = options.ransac.max_error_on_floor(
      std::max(from.viewpoint.metres_per_pixel, to.viewpoint.metres_per_pixel));
  const cv::Mat affine = cv::estimateAffinePartial2D(pairs.q, pairs.p, inliers, cv::RANSAC,
                                                     max_error_m / metres_per_pixel);
  answer.solve_ms = solve_watch.milliseconds();
  if (affine.empty() || cv::countNonZero(inliers) < options.ransac.min_inliers) return answer;
  answer.motion =
      Pose{affine.at<double>(0, 2) * metres_per_pixel, affine.at<double>(1, 2) * metres_per_pixel,
           std::atan2(affine.at<double>(1, 0), affine.at<double>(0, 0))};
  return answer;
}

}  // namespace fathom::benchmarks

#include "fathom/harness/remarks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <utility>

#include "fathom/core/chi_squared.hpp"
#include "fathom/vision/camera.hpp"

namespace fathom {
namespace {

std::string number(double value, int digits = 3) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.*g", digits, value);
  return buffer;
}

std::string whole(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.0f", value);
  return buffer;
}

std::string range_text(const Spread& spread) {
  const std::string least = number(spread.least);
  const std::string most = number(spread.most);
  return least == most ? least : least + " to " + most;
}

struct Pass {
  double distance_m = std::numeric_limits<double>::infinity();
  std::size_t from = 0;
  std::size_t to = 0;
};

// The nearest that dead reckoning comes to where it was before: of keyframes with a path between
// them of several times the reach, and of twice their distance, so that it turned back. Of a long
// survey some keyframes stand for all.
Pass nearest_pass(const std::vector<Pose>& poses, double reach_m) {
  constexpr double kPath = 4.0;
  constexpr std::size_t kLooked = 2000;
  const std::size_t stride = poses.size() / kLooked + 1;
  std::vector<double> path_m(poses.size(), 0.0);
  for (std::size_t k = 1; k < poses.size(); ++k) {
    path_m[k] = path_m[k - 1] + (poses[k].position() - poses[k - 1].position()).norm();
  }
  Pass nearest;
  for (std::size_t k = 0; k < poses.size(); k += stride) {
    for (std::size_t j = 0; j < k && path_m[k] - path_m[j] > kPath * reach_m; j += stride) {
      const double distance_m = (poses[k].position() - poses[j].position()).norm();
      if (2.0 * distance_m > path_m[k] - path_m[j]) continue;
      if (distance_m < nearest.distance_m) nearest = {distance_m, j, k};
    }
  }
  return nearest;
}

std::string no_candidates(const Recording& recording) {
  const Spread& reach_m = recording.in_metres->reach_m;
  const Pass pass = nearest_pass(recording.log.odometry(), reach_m.most);
  std::string text = "no loop candidates among " + std::to_string(recording.log.size()) +
                     " keyframes: none has an earlier one within reach, " + range_text(reach_m) +
                     " m; ";
  if (!std::isfinite(pass.distance_m)) {
    return text +
           "by dead reckoning the path never returns to where it was, so there is nothing to "
           "correct it";
  }
  return text + "by dead reckoning the nearest pass, keyframes " + std::to_string(pass.from) +
         " and " + std::to_string(pass.to) + ", is " + number(pass.distance_m) +
         " m away: a larger front_end.candidates.max_distance_m, or a dead reckoning whose "
         "covariance says how far it may be off";
}

std::string none_registered(const Recording& recording, const FrontEndOptions& options) {
  return "0 of " + std::to_string(recording.registrations_tried) +
         " candidate pairs registered: in the best of them " +
         std::to_string(recording.most_refused_inliers) + " matches agree, where at least " +
         std::to_string(options.registration.ransac.min_inliers) +
         " are needed, and more than chance would bring together: look at altitude and focal "
         "length, at the pictures' texture ('fathom check DIR'), and at a pair that should match "
         "('fathom register A B')";
}

// Pairs of keyframes that share enough floor for a registration to be expected.
struct Overlapping {
  std::size_t pairs = 0;
  std::size_t registered = 0;
};

constexpr double kEnoughOverlap = 0.3;

Overlapping overlapping(const Recording& recording, std::span<const Pose> estimate) {
  const TrueOverlaps overlaps =
      overlaps_at(estimate, *recording.camera, recording.keyframe_altitudes_m);
  Overlapping count;
  for (const TrueOverlaps::Pair& pair : overlaps.pairs) {
    if (pair.overlap >= kEnoughOverlap) ++count.pairs;
  }
  for (std::size_t k = 1; k < recording.log.size(); ++k) {
    for (const RelativePose& z : recording.log.arrival(k).registrations) {
      const auto [first, last] = std::minmax(z.from, z.to);
      if (overlaps.of(first, last) >= kEnoughOverlap) ++count.registered;
    }
  }
  return count;
}

std::string few_registered(const Recording& recording, const Overlapping& count) {
  return std::to_string(count.registered) + " registrations, where by the estimate " +
         std::to_string(count.pairs) + " pairs of keyframes share 30 % of a picture or more (" +
         std::to_string(recording.registrations_tried) + " tried, " +
         std::to_string(recording.log.registration_count()) + " found" +
         (recording.registrations_left_out > 0
              ? ", " + std::to_string(recording.registrations_left_out) + " beyond the budget"
              : "") +
         "; of those refused the best has " + std::to_string(recording.most_refused_inliers) +
         " matches that agree): altitude and focal length, the pictures' texture and blur, or a "
         "larger front_end.ransac.max_error_px";
}

// How long registered motions are in units of dead reckoning's, where that is sure of its own.
std::vector<double> lengths(const Recording& recording) {
  constexpr std::size_t kApart = 3;
  constexpr double kSigmas = 5.0;
  std::vector<double> ratios;
  const MeasurementLog& log = recording.log;
  for (std::size_t k = 1; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) {
      const auto [first, last] = std::minmax(z.from, z.to);
      if (last - first > kApart) continue;
      UncertainPose reckoned;
      for (std::size_t i = first + 1; i <= last; ++i) {
        const RelativePose& step = log.arrival(i).step;
        reckoned = compose(reckoned, {step.motion, step.covariance()});
      }
      const double length_m = reckoned.mean.position().norm();
      const double variance = reckoned.covariance.topLeftCorner<2, 2>().trace();
      if (length_m > kSigmas * std::sqrt(variance)) {
        ratios.push_back(z.motion.position().norm() / length_m);
      }
    }
  }
  return ratios;
}

// A wrong altitude or focal length scales all registered motions.
std::optional<std::string> wrong_scale(const Recording& recording) {
  constexpr std::size_t kEnough = 5;
  constexpr double kFactor = 1.2;
  std::vector<double> ratios = lengths(recording);
  if (recording.visual_odometry || ratios.size() < kEnough) return std::nullopt;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  const double factor = *middle;
  if (factor < kFactor && factor > 1.0 / kFactor) return std::nullopt;
  return "registered motions are " + number(factor) +
         " times as long as dead reckoning has them (median of " + std::to_string(ratios.size()) +
         " between near keyframes): the altitude or the focal length is too " +
         (factor > 1.0 ? "large" : "small") +
         " by this factor, or dead reckoning is; 3.28 is feet for metres";
}

}  // namespace

bool MapFit::estimate_fits() const {
  constexpr double kProbability = 0.99;
  const double scale = std::max(1.0, per_degree_of_freedom());
  return chi2 - chi2_optimum <= scale * chi_squared_quantile(kProbability, unknowns);
}

std::optional<MapFit> map_fit(const MeasurementLog& log, std::span<const Pose> estimate,
                              const BatchOptimum& optimum) {
  if (log.registration_count() == 0) return std::nullopt;
  MapFit fit;
  fit.chi2 = chi2(log, estimate);
  fit.chi2_optimum = optimum.chi2;
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  for (std::size_t k = 1; k < log.size(); ++k) {
    const RelativePose& step = log.arrival(k).step;
    const Eigen::Vector3d e =
        residual(step.motion, optimum.poses[step.from], optimum.poses[step.to]);
    fit.steps_at_optimum += e.dot(step.information * e);
    for (const RelativePose& z : log.arrival(k).registrations) {
      squares += residual(z.motion, optimum.poses[z.from], optimum.poses[z.to]).cwiseAbs2();
      variances += z.covariance().diagonal();
    }
  }
  const auto count = static_cast<double>(log.registration_count());
  fit.registration_rms_m = std::sqrt((squares.x() + squares.y()) / count);
  fit.registration_rms_rad = std::sqrt(squares.z() / count);
  fit.registration_sigma_m = std::sqrt((variances.x() + variances.y()) / count);
  fit.registration_sigma_rad = std::sqrt(variances.z() / count);
  fit.degrees_of_freedom = 3.0 * static_cast<double>(log.registration_count());
  fit.unknowns = 3.0 * static_cast<double>(log.size() - 1);
  return fit;
}

std::vector<std::string> loop_remarks(const Recording& recording, const FrontEndOptions& options,
                                      std::span<const Pose> estimate) {
  if (!recording.in_metres || !recording.camera) return {};
  if (recording.registrations_tried == 0) return {no_candidates(recording)};
  if (recording.log.registration_count() == 0) return {none_registered(recording, options)};
  std::vector<std::string> remarks;
  if (auto scale = wrong_scale(recording)) remarks.push_back(std::move(*scale));
  constexpr std::size_t kEnough = 5;
  constexpr double kShare = 0.5;
  const Overlapping count = overlapping(recording, estimate);
  if (count.pairs >= kEnough &&
      static_cast<double>(count.registered) < kShare * static_cast<double>(count.pairs)) {
    remarks.push_back(few_registered(recording, count));
  }
  return remarks;
}

std::vector<std::string> map_remarks(const MapFit& fit, const std::string& estimator,
                                     const std::string& solver) {
  std::vector<std::string> remarks;
  if (!fit.estimate_fits()) {
    remarks.push_back("the map of " + estimator + " does not fit its own measurements: F is " +
                      whole(fit.chi2) + ", and " + whole(fit.chi2_optimum) +
                      " where a batch solve of the same log ends; " + solver + " would do");
  }
  constexpr double kTooMuch = 3.0;
  if (fit.per_degree_of_freedom() > kTooMuch) {
    const double share = fit.steps_at_optimum / fit.chi2_optimum;
    remarks.push_back(
        "the measurements do not fit each other: F per degree of freedom is " +
        number(fit.per_degree_of_freedom()) + " at its best, and 1 is expected; " +
        number(100.0 * share, 2) + " % of F is of dead reckoning, so " +
        (share > 0.5
             ? "its covariance is too small for what loops say (dataset.added_noise)"
             : "covariances of registrations are too small (front_end.covariance) or some loops "
               "are wrong (a robust loss, a gate): registrations are off by " +
                   number(fit.registration_rms_m, 2) + " m and " +
                   number(fit.registration_rms_rad, 2) +
                   " rad there (rms), where their "
                   "covariances say " +
                   number(fit.registration_sigma_m, 2) + " m and " +
                   number(fit.registration_sigma_rad, 2) + " rad"));
  }
  return remarks;
}

}  // namespace fathom

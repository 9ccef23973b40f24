#include "fathom/evaluation/accuracy.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "checks.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/keyframe_pairs.hpp"

namespace fathom {
namespace {

double mean(std::span<const double> values) {
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

double root_mean_square(std::span<const double> values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

std::optional<RelativeError> relative_error_of(std::span<const Pose> estimate,
                                               std::span<const Pose> reference,
                                               std::span<const KeyframePair> pairs) {
  if (pairs.empty() || !all_finite(estimate) || !all_finite(reference)) return std::nullopt;
  std::vector<double> translations;
  std::vector<double> rotations;
  for (const auto& [from, to] : pairs) {
    const Pose error =
        between(between(reference[from], reference[to]), between(estimate[from], estimate[to]));
    translations.push_back(std::hypot(error.x, error.y));
    rotations.push_back(std::abs(error.theta));
  }
  RelativeError result;
  result.pairs = pairs.size();
  result.translation_mean_m = mean(translations);
  result.translation_rmse_m = root_mean_square(translations);
  result.rotation_mean_rad = mean(rotations);
  result.rotation_rmse_rad = root_mean_square(rotations);
  if (!std::isfinite(result.translation_rmse_m)) return std::nullopt;
  return result;
}

}  // namespace

std::vector<double> position_errors_m(std::span<const Pose> estimate,
                                      std::span<const Pose> reference) {
  require_same_length(estimate.size(), reference.size(), "the reference");
  std::vector<double> errors;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    errors.push_back(std::hypot(estimate[k].x - reference[k].x, estimate[k].y - reference[k].y));
  }
  return errors;
}

std::vector<double> heading_errors_rad(std::span<const Pose> estimate,
                                       std::span<const Pose> reference) {
  require_same_length(estimate.size(), reference.size(), "the reference");
  std::vector<double> errors;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    errors.push_back(wrap_angle(estimate[k].theta - reference[k].theta));
  }
  return errors;
}

bool leaves_an_error(std::size_t poses, Alignment alignment) {
  return poses > (alignment == Alignment::none ? 0U : 1U);
}

std::optional<Accuracy> accuracy(std::span<const Pose> estimate, std::span<const Pose> reference,
                                 Alignment alignment) {
  const Aligned aligned = align(estimate, reference, alignment);
  if (estimate.empty()) throw InputError("there is no pose to compare with its reference");
  if (!leaves_an_error(estimate.size(), alignment)) return std::nullopt;
  if (!all_finite(estimate) || !all_finite(reference)) return std::nullopt;
  const std::vector<double> distances = position_errors_m(aligned.poses, reference);
  Accuracy result;
  result.alignment = alignment;
  result.motion_reference_estimate = aligned.motion_reference_estimate;
  result.mean_position_error_m = mean(distances);
  result.ate_rmse_m = root_mean_square(distances);
  result.max_position_error_m = *std::max_element(distances.begin(), distances.end());
  result.final_position_error_m = distances.back();
  result.heading_rmse_rad = root_mean_square(heading_errors_rad(aligned.poses, reference));
  if (!std::isfinite(result.ate_rmse_m)) return std::nullopt;
  return result;
}

std::optional<RelativeError> relative_error(std::span<const Pose> estimate,
                                            std::span<const Pose> reference,
                                            std::size_t separation_keyframes) {
  require_same_length(estimate.size(), reference.size(), "the reference");
  if (separation_keyframes == 0) {
    throw InputError("a relative error needs a separation of at least 1 keyframe, got 0");
  }
  return relative_error_of(estimate, reference,
                           pairs_over_keyframes(estimate.size(), separation_keyframes));
}

std::optional<RelativeError> relative_error_over(std::span<const Pose> estimate,
                                                 std::span<const Pose> reference,
                                                 double distance_m) {
  require_same_length(estimate.size(), reference.size(), "the reference");
  if (!(distance_m > 0.0)) {
    throw InputError("a relative error needs a distance above 0 m, got " +
                     std::to_string(distance_m));
  }
  if (!all_finite(reference)) return std::nullopt;
  return relative_error_of(estimate, reference, pairs_over_distance(reference, distance_m));
}

}  // namespace fathom

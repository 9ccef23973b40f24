#include "fathom/evaluation/spatial_accuracy.hpp"

#include <cmath>

#include "checks.hpp"

namespace fathom {
namespace {

using Trajectory = std::span<const StampedSpatialPose>;

std::vector<Pose> poses_of(const Projection& projection) {
  std::vector<Pose> poses;
  for (const StampedPose& stamped : projection.trajectory) poses.push_back(stamped.pose);
  return poses;
}

bool are_mounted_alike(const BodyAxes& a, const BodyAxes& b) {
  constexpr double kCosineOf60Degrees = 0.5;
  return a.mean_up.dot(b.mean_up) >= kCosineOf60Degrees * a.mean_up.norm() * b.mean_up.norm();
}

void put_errors(SpatialAccuracy& result, SpatialAlignment alignment) {
  const auto& [estimate, reference] = result.poses;
  result.accuracy = accuracy(estimate, reference, on_plane(alignment));
  const Aligned aligned = align(estimate, reference, on_plane(alignment));
  result.position_errors_m = position_errors_m(aligned.poses, reference);
  for (const double error : heading_errors_rad(aligned.poses, reference)) {
    result.heading_errors_rad.push_back(std::abs(error));
  }
  const auto& heights_m = result.estimate.projection.heights_m;
  const auto& true_heights_m = result.reference.projection.heights_m;
  const double shift_m = height_shift_m(heights_m, true_heights_m, alignment);
  for (std::size_t k = 0; k < heights_m.size(); ++k) {
    result.height_errors_m.push_back(heights_m[k] + shift_m - true_heights_m[k]);
  }
}

}  // namespace

SpatialAccuracy spatial_accuracy(Trajectory estimate, Trajectory reference, PlanePair planes,
                                 SpatialAlignment alignment) {
  SpatialAccuracy result;
  result.reference = {planes.reference, axes_of(planes.reference, reference), {}};
  const std::optional<Plane> next_to =
      planes.reference == Plane::fit ? std::optional(result.reference.axes.named) : std::nullopt;
  result.estimate = {planes.estimate, axes_of(planes.estimate, estimate, next_to), {}};
  result.body = body_axes(reference, result.reference.axes);
  result.is_mounted_alike =
      are_mounted_alike(result.body, body_axes(estimate, result.estimate.axes));
  result.estimate.projection = project(estimate, result.estimate.axes, result.body);
  result.reference.projection = project(reference, result.reference.axes, result.body);
  result.poses = {poses_of(result.estimate.projection), poses_of(result.reference.projection)};
  put_errors(result, alignment);
  return result;
}

std::vector<double> with_heights(std::span<const double> position_errors_m,
                                 std::span<const double> height_errors_m) {
  require_same_length(position_errors_m.size(), height_errors_m.size(), "the list of heights");
  std::vector<double> distances_m;
  for (std::size_t k = 0; k < height_errors_m.size(); ++k) {
    distances_m.push_back(std::hypot(position_errors_m[k], height_errors_m[k]));
  }
  return distances_m;
}

}  // namespace fathom

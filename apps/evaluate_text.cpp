#include "apps/evaluate_text.hpp"

#include <cmath>
#include <cstdio>

#include "apps/trajectories.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/evaluation/error_statistics.hpp"

namespace fathom {
namespace {

Projected projected(const std::vector<StampedSpatialPose>& trajectory, Plane plane) {
  Projected result;
  result.plane = plane;
  result.axes = axes_of(plane, trajectory);
  return result;
}

std::vector<Pose> poses_of(const Projected& projected) {
  std::vector<Pose> poses;
  for (const StampedPose& stamped : projected.projection.trajectory) poses.push_back(stamped.pose);
  return poses;
}

// Axes of a camera beside those of a vehicle, for example.
bool are_mounted_alike(const BodyAxes& a, const BodyAxes& b) {
  constexpr double kHalf = 0.5;
  return a.mean_up.dot(b.mean_up) >= kHalf * a.mean_up.norm() * b.mean_up.norm();
}

Table relative_table(const AssociatedPoses& poses, const RelativeLengths& lengths) {
  Table table({"relative error over", "pairs", "translation RMSE (m)", "mean (m)",
               "rotation RMSE (rad)", "mean (rad)"});
  const auto add = [&table](const std::string& what, const std::optional<RelativeError>& error) {
    const auto cell = [&error](double RelativeError::*figure) {
      return error ? format_number((*error).*figure, 6) : "-";
    };
    table.add_row(
        {what, error ? std::to_string(error->pairs) : "0", cell(&RelativeError::translation_rmse_m),
         cell(&RelativeError::translation_mean_m), cell(&RelativeError::rotation_rmse_rad),
         cell(&RelativeError::rotation_mean_rad)});
  };
  for (const std::size_t step : lengths.steps) {
    add(std::to_string(step) + (step == 1 ? " pose" : " poses"),
        relative_error(poses.estimate, poses.reference, step));
  }
  for (const double distance_m : lengths.distances_m) {
    add(format_number(distance_m, 3) + " m",
        relative_error_over(poses.estimate, poses.reference, distance_m));
  }
  return table;
}

Table absolute_table(const Judged& judged) {
  const Accuracy& accuracy = *judged.accuracy;
  const auto position = error_statistics(judged.position_errors_m);
  const auto heading = error_statistics(judged.heading_errors_rad);
  Table table({"", "error"});
  const auto add = [&table](const std::string& what, const std::optional<double>& value) {
    table.add_row({what, format_number(value, 6)});
  };
  const auto of = [](const std::optional<ErrorStatistics>& statistics,
                     double ErrorStatistics::*figure) -> std::optional<double> {
    if (!statistics) return std::nullopt;
    return (*statistics).*figure;
  };
  add("mean position error (m)", accuracy.mean_position_error_m);
  add("ATE RMSE (m)", accuracy.ate_rmse_m);
  add("median position error (m)", of(position, &ErrorStatistics::median));
  add("standard deviation (m)", of(position, &ErrorStatistics::std));
  add("smallest position error (m)", of(position, &ErrorStatistics::min));
  add("largest position error (m)", accuracy.max_position_error_m);
  add("final position error (m)", accuracy.final_position_error_m);
  add("sum of squares (m^2)", of(position, &ErrorStatistics::sse));
  add("heading RMSE (rad)", accuracy.heading_rmse_rad);
  add("mean heading error (rad)", of(heading, &ErrorStatistics::mean));
  add("largest heading error (rad)", of(heading, &ErrorStatistics::max));
  return table;
}

// Of two that lie on plane xy there is nothing to say.
bool is_planar(const Judged& judged) {
  const auto is_plain = [](const Projected& of) {
    return of.plane == Plane::xy && is_flat(of.projection.loss);
  };
  const auto heights = error_statistics(judged.height_errors_m);
  return is_plain(judged.estimate) && is_plain(judged.reference) && heights && heights->sse < 1e-18;
}

void print_losses(const Judged& judged, const std::string& alignment) {
  Table table({"left out by the projection", "estimate", "reference"});
  const auto cells = [](const Projected& of) {
    return loss_cells(plane_text(of.plane, of.axes), of.projection.loss);
  };
  const auto estimate = cells(judged.estimate);
  const auto reference = cells(judged.reference);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    table.add_row({loss_rows()[i], estimate[i], reference[i]});
  }
  std::printf("\n%s", table.text().c_str());
  double heights = 0.0;
  double positions = 0.0;
  for (std::size_t k = 0; k < judged.height_errors_m.size(); ++k) {
    heights += judged.height_errors_m[k] * judged.height_errors_m[k];
    positions += judged.position_errors_m[k] * judged.position_errors_m[k];
  }
  const double count = static_cast<double>(judged.height_errors_m.size());
  std::printf("height error, alignment %s: RMSE %s m; with the position error on the plane %s m\n",
              alignment.c_str(), format_number(std::sqrt(heights / count), 6).c_str(),
              format_number(std::sqrt((heights + positions) / count), 6).c_str());
}

}  // namespace

Judged judge(const SpatialPairs& pairs, Plane plane_of_estimate, Plane plane_of_reference,
             SpatialAlignment alignment, const std::string& name) {
  Judged judged;
  judged.estimate = projected(pairs.estimate, plane_of_estimate);
  judged.reference = projected(pairs.reference, plane_of_reference);
  // Heading is of one axis of the body in both: the reference says which.
  const BodyAxes body = body_axes(pairs.reference, judged.reference.axes);
  judged.estimate.projection = project(pairs.estimate, judged.estimate.axes, body);
  judged.reference.projection = project(pairs.reference, judged.reference.axes, body);
  judged.poses = {poses_of(judged.estimate), poses_of(judged.reference)};
  judged.accuracy = accuracy(judged.poses.estimate, judged.poses.reference, on_plane(alignment));
  if (leaves_an_error(pairs.estimate.size(), on_plane(alignment)) && !judged.accuracy) {
    throw InputError(name, "has errors too large for a number");
  }
  const Aligned aligned = align(judged.poses.estimate, judged.poses.reference, on_plane(alignment));
  judged.position_errors_m = position_errors_m(aligned.poses, judged.poses.reference);
  for (const double e : heading_errors_rad(aligned.poses, judged.poses.reference)) {
    judged.heading_errors_rad.push_back(std::abs(e));
  }
  const auto& heights_m = judged.estimate.projection.heights_m;
  const auto& true_heights_m = judged.reference.projection.heights_m;
  const double shift_m = height_shift_m(heights_m, true_heights_m, alignment);
  for (std::size_t k = 0; k < heights_m.size(); ++k) {
    judged.height_errors_m.push_back(heights_m[k] + shift_m - true_heights_m[k]);
  }
  const auto add = [&](const std::vector<StampedSpatialPose>& trajectory, const Projected& of,
                       const std::string& which) {
    for (auto& warning : projection_warnings(trajectory, of.axes, of.projection, body, which)) {
      judged.warnings.push_back(std::move(warning));
    }
  };
  add(pairs.estimate, judged.estimate, "the estimate");
  add(pairs.reference, judged.reference, "the reference");
  if (!are_mounted_alike(body, body_axes(pairs.estimate, judged.estimate.axes))) {
    judged.warnings.push_back(
        "different axes of the body point up in the estimate and in the reference: their headings "
        "are of different axes, and only errors of alignment none, se2 or yaw in position count");
  }
  return judged;
}

void print_judged(const Judged& judged, const SpatialPairs& pairs, const std::string& alignment,
                  const RelativeLengths& lengths) {
  const Table relative = relative_table(judged.poses, lengths);  // refuses before any output
  std::printf("%zu of %zu poses have a reference; alignment %s, scale as it is\n",
              pairs.estimate.size(), pairs.estimate_size, alignment.c_str());
  if (pairs.by_index) std::printf("paired by index: neither trajectory has times\n");
  std::printf("\n");
  if (judged.accuracy) {
    std::printf("%s", absolute_table(judged).text().c_str());
  } else {
    std::printf("no error can be given: alignment %s lays a single pose on its reference\n",
                alignment.c_str());
  }
  std::printf("\n%s", relative.text().c_str());
  if (!is_planar(judged)) print_losses(judged, alignment);
  for (const std::string& warning : judged.warnings) {
    std::printf("warning: %s\n", warning.c_str());
  }
}

}  // namespace fathom

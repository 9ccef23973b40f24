#include "fathom/report/evaluation_text.hpp"

#include <cmath>
#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "fathom/evaluation/error_statistics.hpp"
#include "fathom/report/projection_text.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

std::vector<double> absolute(const std::vector<double>& values) {
  std::vector<double> result;
  result.reserve(values.size());
  for (const double value : values) result.push_back(std::abs(value));
  return result;
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
    add(counted(step, "pose"), relative_error(poses.estimate, poses.reference, step));
  }
  for (const double distance_m : lengths.distances_m) {
    add(format_number(distance_m, 3) + " m",
        relative_error_over(poses.estimate, poses.reference, distance_m));
  }
  return table;
}

// Relative errors run over the poses with a reference, past what has none.
std::string gaps_text(const std::vector<std::size_t>& paired, const RelativeLengths& lengths) {
  std::string text;
  const auto longer = [&paired](std::size_t step) {
    std::size_t count = 0;
    for (std::size_t i = 0; i + step < paired.size(); ++i) {
      count += paired[i + step] - paired[i] > step ? 1 : 0;
    }
    return count;
  };
  for (const std::size_t step : lengths.steps) {
    const std::size_t count = longer(step);
    if (count == 0) continue;
    text += fmt::format(
        "warning: {} of {} pairs over {} lie further apart in the estimate, with poses between "
        "them that have no reference: their errors are of longer ways\n",
        count, paired.size() - step, counted(step, "pose"));
  }
  if (!lengths.distances_m.empty() && longer(1) > 0) {
    text +=
        "warning: the reference has gaps, which relative errors over a distance take as straight: "
        "their ways are longer\n";
  }
  return text;
}

Table absolute_table(const SpatialAccuracy& judged) {
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
bool is_planar(const SpatialAccuracy& judged) {
  const auto is_plain = [](const ProjectedTrajectory& of) {
    return of.plane == Plane::xy && is_flat(of.projection.loss);
  };
  const auto heights = error_statistics(absolute(judged.height_errors_m));
  return is_plain(judged.estimate) && is_plain(judged.reference) && heights && heights->max < 1e-9;
}

std::string losses_text(const SpatialAccuracy& judged, const std::string& alignment) {
  Table table({"left out by the projection", "estimate", "reference"});
  const auto cells = [](const ProjectedTrajectory& of) {
    return loss_cells(plane_text(of.plane, of.axes), of.projection.loss);
  };
  const auto estimate = cells(judged.estimate);
  const auto reference = cells(judged.reference);
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    table.add_row({loss_rows()[i], estimate[i], reference[i]});
  }
  const auto heights = error_statistics(absolute(judged.height_errors_m));
  const auto all = error_statistics(with_heights(judged.position_errors_m, judged.height_errors_m));
  const auto rmse = [](const std::optional<ErrorStatistics>& statistics) {
    return statistics ? format_number(statistics->rmse, 6) : "-";
  };
  return fmt::format(
      "\n{}height error, alignment {}: RMSE {} m; with the position error on the plane {} m\n",
      table.text(), alignment, rmse(heights), rmse(all));
}

std::string warnings_text(const SpatialAccuracy& judged) {
  std::string text;
  for (const auto& [which, of] : {std::pair{"the estimate", &judged.estimate},
                                  std::pair{"the reference", &judged.reference}}) {
    for (const std::string& warning :
         projection_warnings(of->axes, of->projection, judged.body, which)) {
      text += "warning: " + warning + "\n";
    }
  }
  if (judged.is_mounted_alike) return text;
  return text +
         "warning: different axes of the body point up in the estimate and in the reference: "
         "headings and relative errors compare different axes, and alignment origin rests on them; "
         "has one of them another plane?\n";
}

}  // namespace

std::string evaluation_text(const SpatialAccuracy& judged, const EvaluationHead& head,
                            const RelativeLengths& lengths) {
  std::string text = fmt::format("{} of {} poses have a reference; alignment {}, scale as it is\n",
                                 judged.poses.estimate.size(), head.estimate_size, head.alignment);
  if (head.is_paired_by_index) text += "paired by index: neither trajectory has times\n";
  text += "\n";
  text +=
      judged.accuracy
          ? absolute_table(judged).text()
          : fmt::format("no error can be given: alignment {} lays a single pose on its reference\n",
                        head.alignment);
  text += "\n" + relative_table(judged.poses, lengths).text();
  text += gaps_text(head.paired, lengths);
  if (!is_planar(judged)) text += losses_text(judged, head.alignment);
  return text + warnings_text(judged);
}

}  // namespace fathom

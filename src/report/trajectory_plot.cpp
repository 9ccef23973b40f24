#include "fathom/report/trajectory_plot.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "fathom/core/input_error.hpp"
#include "figure_file.hpp"
#include "map_frame.hpp"
#include "text_layout.hpp"
#include "trajectory_map.hpp"

namespace fathom {
namespace {

constexpr PageSize kSmallPage{480.0, 360.0};
constexpr double kPixelsPerPoint = 2.5;
constexpr double kTitleSize = 11.0;

void check(const TrajectoryPlot& plot) {
  for (const PlotSeries& series : plot.series) {
    if (!series.covariances.empty() && series.covariances.size() != series.poses.size()) {
      throw InputError(
          fmt::format("'{}' has {} poses and {} covariances; there must be one per pose, or none",
                      series.name, series.poses.size(), series.covariances.size()));
    }
    for (const AbsoluteMark& mark : series.absolute) {
      if (mark.pose < series.poses.size()) continue;
      throw InputError(fmt::format("'{}' has a measurement of pose {}, but only {} poses",
                                   series.name, mark.pose, series.poses.size()));
    }
    for (const auto& [from, to] : series.loops) {
      if (std::max(from, to) >= series.poses.size()) {
        throw InputError(fmt::format("'{}' has a loop from pose {} to {}, but only {} poses",
                                     series.name, from, to, series.poses.size()));
      }
    }
  }
}

std::size_t count_left_out(const TrajectoryPlot& plot) {
  std::size_t count = 0;
  for (const PlotSeries& series : plot.series) {
    count += static_cast<std::size_t>(std::count_if(series.poses.begin(), series.poses.end(),
                                                    [](const Pose& p) { return !is_drawable(p); }));
  }
  return count;
}

// What was left out is said whole; a long title gives way to it.
std::string full_title(const TrajectoryPlot& plot, double most) {
  const std::size_t left_out = count_left_out(plot);
  const std::string note = left_out == 0
                               ? ""
                               : fmt::format("  [{} {} not finite or too far, not drawn]", left_out,
                                             left_out == 1 ? "pose is" : "poses are");
  return shortened(plot.title, kTitleSize, most - text_width(note, kTitleSize)) + note;
}

void draw(Canvas& canvas, const TrajectoryPlot& plot, const PageSize& page) {
  constexpr double kMargin = 14.0;
  const double width = page.width - 2.0 * kMargin;
  const TrajectoryMap map(plot);
  const ChartLegend legend(map.legend(), width);
  canvas.text(full_title(plot, width), {kMargin, kMargin + 7.0}, {.size = kTitleSize});
  constexpr double kLegendTop = kMargin + 15.0;
  legend.draw(canvas, {kMargin, kLegendTop});
  const double top = kLegendTop + legend.height() + 4.0;
  map.draw(canvas, {kMargin, top, width, std::max(40.0, page.height - top - kMargin)});
}

// Of the shape of the map, so that a narrow one has no white beside it; room for a legend is left.
PageSize page_of(const TrajectoryPlot& plot) {
  constexpr PageSize kLeast{400.0, 320.0};
  constexpr PageSize kMost{640.0, 640.0};
  constexpr PageSize kRound{60.0, 85.0};  // what is not map: title, legend, axes
  const Eigen::AlignedBox2d extent = map_extent(plot.series);
  if (extent.isEmpty() || !(extent.sizes().maxCoeff() > 0.0)) return kLeast;
  const Eigen::Vector2d size = extent.sizes();
  const double scale =
      std::min((kMost.width - kRound.width) / size.y(), (kMost.height - kRound.height) / size.x());
  return {std::clamp(kRound.width + scale * size.y(), kLeast.width, kMost.width),
          std::clamp(kRound.height + scale * size.x(), kLeast.height, kMost.height)};
}

}  // namespace

std::string trajectory_png(const TrajectoryPlot& plot) {
  check(plot);
  const PageSize page = page_of(plot);
  return render_figure(
      FigureFormat::png, page, [&](Canvas& canvas) { draw(canvas, plot, page); }, kPixelsPerPoint);
}

std::string trajectory_svg(const TrajectoryPlot& plot) {
  check(plot);
  return render_figure(FigureFormat::svg, kSmallPage,
                       [&plot](Canvas& canvas) { draw(canvas, plot, kSmallPage); });
}

}  // namespace fathom

#include "fathom/report/world_file.hpp"

#include "fathom/core/text.hpp"

namespace fathom {
namespace {

/// Coordinates as a linear function of column and row.
struct PixelAxes {
  Eigen::Vector2d first;   ///< the centre of the first pixel
  Eigen::Vector2d column;  ///< from a column to the next
  Eigen::Vector2d row;
};

/// In the map.
PixelAxes axes_of(const MosaicPlan& plan, const cv::Rect& window) {
  const double side_m = plan.metres_per_pixel;
  const Eigen::Vector2d column(0.0, -side_m);
  const Eigen::Vector2d row(-side_m, 0.0);
  return {plan.top_left_m + (window.x + 0.5) * column + (window.y + 0.5) * row, column, row};
}

// x ahead and y to port, or grid north and west, as a world file has them: to the right, then up.
Eigen::Vector2d right_and_up(const Eigen::Vector2d& ahead_and_port) {
  // 0 and not -0, for the eye.
  return {0.0 - ahead_and_port.y(), ahead_and_port.x() + 0.0};
}

std::string text_of(const PixelAxes& axes) {
  std::string text;
  for (const Eigen::Vector2d& value : {axes.column, axes.row, axes.first}) {
    text += number_text(value.x()) + "\n" + number_text(value.y()) + "\n";
  }
  return text;
}

}  // namespace

std::string world_file(const MosaicPlan& plan, const cv::Rect& window) {
  const PixelAxes map = axes_of(plan, window);
  return text_of({right_and_up(map.first), right_and_up(map.column), right_and_up(map.row)});
}

std::string world_file(const MosaicPlan& plan, const cv::Rect& window, const EarthFrame& earth) {
  const PixelAxes map = axes_of(plan, window);
  const Eigen::Vector2d middle =
      map.first + 0.5 * (window.width - 1) * map.column + 0.5 * (window.height - 1) * map.row;
  const GridPose grid = earth.on_grid({middle.x(), middle.y(), 0.0});
  const auto turned = [&](const Eigen::Vector2d& step) -> Eigen::Vector2d {
    return grid.scale * (transform(grid.pose, step) - grid.pose.position());
  };
  const Eigen::Vector2d first = grid.pose.position() + turned(map.first - middle);
  return text_of({earth.easting_northing(first), right_and_up(turned(map.column)),
                  right_and_up(turned(map.row))});
}

}  // namespace fathom

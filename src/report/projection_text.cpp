#include "fathom/report/projection_text.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "fathom/report/table.hpp"

namespace fathom {

std::vector<std::string> projection_warnings(const PlaneAxes& axes, const Projection& projection,
                                             const BodyAxes& body, const std::string& which) {
  const ProjectionLoss& loss = projection.loss;
  if (loss.better) {
    return {
        fmt::format("{} is off plane {} by {} m (RMS), and off plane {} by less than a quarter of "
                    "that: --plane {} may be meant",
                    which, name_of(axes.named), format_number(loss.height_rms_m, 3),
                    name_of(*loss.better), name_of(*loss.better))};
  }
  std::vector<std::string> warnings;
  if (body.forward.z() != 0.0) {
    warnings.push_back("the x axis of the body points up or down in " + which +
                       ": the heading is that of its z axis");
  }
  if (loss.open_headings > 0) {
    warnings.push_back(
        fmt::format("{} of {} poses of {} point within 10 degrees of up or down: their headings "
                    "say little, and so do errors that rest on them",
                    loss.open_headings, projection.trajectory.size(), which));
  }
  return warnings;
}

std::string plane_text(Plane plane, const PlaneAxes& axes) {
  if (plane != Plane::fit) return name_of(plane);
  return "fit: " + name_of(axes.named) + " tilted by " + format_number(axes.tilt_rad, 3) + " rad";
}

const std::vector<std::string>& loss_rows() {
  static const std::vector<std::string> rows{"plane", "height off it, RMS (m)",
                                             "height off it, largest (m)", "roll RMS (rad)",
                                             "pitch RMS (rad)"};
  return rows;
}

std::vector<std::string> loss_cells(const std::string& plane, const ProjectionLoss& loss) {
  return {plane, format_number(loss.height_rms_m, 5), format_number(loss.height_max_m, 5),
          format_number(loss.roll_rms_rad, 5), format_number(loss.pitch_rms_rad, 5)};
}

bool is_flat(const ProjectionLoss& loss) {
  constexpr double kRounding = 1e-9;
  return std::max({loss.height_max_m, loss.roll_rms_rad, loss.pitch_rms_rad}) < kRounding;
}

}  // namespace fathom

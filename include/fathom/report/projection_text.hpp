#pragma once

#include <string>
#include <vector>

#include "fathom/geometry/plane.hpp"

namespace fathom {

/// What looks wrong with a projection, in sentences; `which` is "the estimate", for example.
std::vector<std::string> projection_warnings(const PlaneAxes& axes, const Projection& projection,
                                             const BodyAxes& body, const std::string& which);

/// "xz", or "fit: xy, tilted by 0.031 rad".
std::string plane_text(Plane plane, const PlaneAxes& axes);

/// Rows "plane", heights, roll and pitch: one column of a table of losses.
std::vector<std::string> loss_cells(const std::string& plane, const ProjectionLoss& loss);
const std::vector<std::string>& loss_rows();

/// Whether a trajectory was on the plane but for rounding.
bool is_flat(const ProjectionLoss& loss);

}  // namespace fathom

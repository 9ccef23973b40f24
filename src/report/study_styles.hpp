#pragma once

#include <map>
#include <string>

#include "canvas.hpp"
#include "fathom/configuration/study_description.hpp"
#include "fathom/report/palette.hpp"

namespace fathom {

/// The style of each estimator of a study by its place, and of dead reckoning.
std::map<std::string, LineStyle> line_styles(const StudyDescription& study);

Pen pen_of(const LineStyle& style, double width);

/// A point of a style: as large as a disc of 3 points.
void draw_mark(Canvas& canvas, const Eigen::Vector2d& centre, const LineStyle& style);

}  // namespace fathom

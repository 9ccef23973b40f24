#pragma once

#include <functional>
#include <string>

#include "canvas.hpp"

namespace fathom {

enum class FigureFormat { svg, pdf, png };

struct PageSize {
  double width = 0.0;
  double height = 0.0;
};

/// The bytes of a file with what `draw` draws on a page of that size in points. A PNG is white and
/// has `pixels_per_point`. Throws InputError if the file cannot be made.
std::string render_figure(FigureFormat format, const PageSize& page,
                          const std::function<void(Canvas&)>& draw, double pixels_per_point = 1.0);

}  // namespace fathom

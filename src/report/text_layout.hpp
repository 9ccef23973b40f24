#pragma once

#include <string>
#include <vector>

#include "page_box.hpp"

// NOLINTNEXTLINE(bugprone-reserved-identifier): the name is cairo's
using cairo_t = struct _cairo;

namespace fathom {

/// The font of charts without hints, so that a text is as wide in every format as it was measured.
void set_chart_font(cairo_t* context, double size);

/// How far a text advances, in the unit of its size.
double text_width(const std::string& text, double size);

/// The box of its ink about the start of its baseline.
Box text_ink(const std::string& text, double size);

/// The text, or as much of its beginning as fits with "…".
std::string shortened(const std::string& text, double size, double most);

/// Its words in lines that fit; a word that is wider than a line is shortened.
std::vector<std::string> wrapped(const std::string& text, double size, double most);

}  // namespace fathom

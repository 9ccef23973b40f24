#include "text_layout.hpp"

#include <algorithm>
#include <cairo.h>
#include <memory>
#include <string_view>

#include "fathom/core/text.hpp"
#include "fathom/core/utf8.hpp"

namespace fathom {
namespace {

using FontOptions = std::unique_ptr<cairo_font_options_t, decltype(&cairo_font_options_destroy)>;

// A surface without area measures like any other, for the font takes no hints.
cairo_text_extents_t extents_of(const std::string& text, double size) {
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create(CAIRO_FORMAT_A8, 0, 0), cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()),
                                                                   cairo_destroy);
  set_chart_font(context.get(), size);
  cairo_text_extents_t extents;
  cairo_text_extents(context.get(), drawable_text(text).c_str(), &extents);
  return extents;
}

}  // namespace

void set_chart_font(cairo_t* context, double size) {
  const FontOptions options(cairo_font_options_create(), cairo_font_options_destroy);
  cairo_font_options_set_hint_metrics(options.get(), CAIRO_HINT_METRICS_OFF);
  cairo_font_options_set_hint_style(options.get(), CAIRO_HINT_STYLE_NONE);
  cairo_font_options_set_antialias(options.get(), CAIRO_ANTIALIAS_GRAY);
  cairo_set_font_options(context, options.get());
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size);
}

double text_width(const std::string& text, double size) {
  return extents_of(text, size).x_advance;
}

Box text_ink(const std::string& text, double size) {
  const cairo_text_extents_t extents = extents_of(text, size);
  return {extents.x_bearing, extents.y_bearing, extents.width, extents.height};
}

std::string shortened(const std::string& text, double size, double most) {
  if (text_width(text, size) <= most) return text;
  std::vector<std::size_t> ends;
  for (std::size_t end = 0; end < text.size(); ends.push_back(end)) {
    end += first_code_point(std::string_view(text).substr(end)).bytes;
  }
  const auto too_long = std::partition_point(ends.begin(), ends.end(), [&](std::size_t end) {
    return text_width(text.substr(0, end) + "…", size) <= most;
  });
  return (too_long == ends.begin() ? "" : text.substr(0, *(too_long - 1))) + "…";
}

std::vector<std::string> wrapped(const std::string& text, double size, double most) {
  std::vector<std::string> lines;
  for (const std::string_view word : split(text, " \t\r\n")) {
    const std::string joined =
        lines.empty() ? std::string(word) : lines.back() + " " + std::string(word);
    if (!lines.empty() && text_width(joined, size) <= most) {
      lines.back() = joined;
    } else {
      lines.push_back(shortened(std::string(word), size, most));
    }
  }
  return lines;
}

}  // namespace fathom

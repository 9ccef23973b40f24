#include "vector_canvas.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <memory>
#include <numbers>

#include "fathom/core/input_error.hpp"

#if defined(__SANITIZE_ADDRESS__)
// fontconfig keeps what it has read of the fonts until the process ends, and frees it never.
extern "C" const char* __lsan_default_suppressions();
extern "C" const char* __lsan_default_suppressions() {
  return "leak:libfontconfig";
}
// Nor is every program that draws a figure to end by listing what was suppressed.
extern "C" const char* __lsan_default_options();
extern "C" const char* __lsan_default_options() {
  return "print_suppressions=0";
}
#endif

namespace fathom {
namespace {

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  const char* text = static_cast<const char*>(static_cast<const void*>(data));
  static_cast<std::string*>(bytes)->append(text, length);
  return CAIRO_STATUS_SUCCESS;
}

void set_colour(cairo_t* context, Colour colour, double opacity) {
  cairo_set_source_rgba(context, colour.red / 255.0, colour.green / 255.0, colour.blue / 255.0,
                        opacity);
}

void trace(cairo_t* context, std::span<const Eigen::Vector2d> points) {
  cairo_new_path(context);
  for (const Eigen::Vector2d& point : points) cairo_line_to(context, point.x(), point.y());
}

void set_font(cairo_t* context, double size) {
  cairo_select_font_face(context, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(context, size);
}

void stroke(cairo_t* context, const Pen& pen) {
  set_colour(context, pen.colour, pen.opacity);
  cairo_set_line_width(context, pen.width);
  cairo_set_line_join(context, CAIRO_LINE_JOIN_ROUND);
  cairo_set_dash(context, pen.dashes.data(), static_cast<int>(pen.dashes.size()), 0.0);
  cairo_stroke(context);
}

}  // namespace

void VectorCanvas::line(std::span<const Eigen::Vector2d> points, const Pen& pen) {
  if (points.size() < 2) return;
  trace(context_, points);
  stroke(context_, pen);
}

void VectorCanvas::area(std::span<const Eigen::Vector2d> outline, Colour colour, double opacity) {
  if (outline.size() < 3) return;
  trace(context_, outline);
  set_colour(context_, colour, opacity);
  cairo_fill(context_);
}

void VectorCanvas::disc(const Eigen::Vector2d& centre, double radius, Colour colour) {
  cairo_new_path(context_);
  cairo_arc(context_, centre.x(), centre.y(), radius, 0.0, 2.0 * std::numbers::pi);
  set_colour(context_, colour, 1.0);
  cairo_fill(context_);
}

void VectorCanvas::ring(const Eigen::Vector2d& centre, double radius, const Pen& pen) {
  cairo_new_path(context_);
  cairo_arc(context_, centre.x(), centre.y(), radius, 0.0, 2.0 * std::numbers::pi);
  stroke(context_, pen);
}

double VectorCanvas::text_width(const std::string& text, double size) {
  set_font(context_, size);
  cairo_text_extents_t extents;
  cairo_text_extents(context_, text.c_str(), &extents);
  return extents.x_advance;
}

void VectorCanvas::text(const std::string& text, const Eigen::Vector2d& at, double size,
                        Colour colour, TextAlign align, bool upwards) {
  const double share = align == TextAlign::left ? 0.0 : align == TextAlign::centre ? 0.5 : 1.0;
  const double shift = -share * text_width(text, size);
  cairo_save(context_);
  cairo_translate(context_, at.x(), at.y());
  if (upwards) cairo_rotate(context_, -std::numbers::pi / 2.0);
  cairo_move_to(context_, shift, 0.0);
  set_colour(context_, colour, 1.0);
  cairo_show_text(context_, text.c_str());
  cairo_restore(context_);
}

void VectorCanvas::clipped(const Box& box, const std::function<void()>& draw) {
  cairo_save(context_);
  cairo_rectangle(context_, box.left, box.top, box.width, box.height);
  cairo_clip(context_);
  draw();
  cairo_restore(context_);
}

std::string render_figure(FigureFormat format, double width, double height,
                          const std::function<void(VectorCanvas&)>& draw) {
  std::string bytes;
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      format == FigureFormat::svg
          ? cairo_svg_surface_create_for_stream(append, &bytes, width, height)
          : cairo_pdf_surface_create_for_stream(append, &bytes, width, height),
      cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()),
                                                                   cairo_destroy);
  VectorCanvas canvas(context.get());
  draw(canvas);
  const cairo_status_t drawn = cairo_status(context.get());
  cairo_surface_finish(surface.get());
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (drawn != CAIRO_STATUS_SUCCESS || status != CAIRO_STATUS_SUCCESS) {
    const cairo_status_t fault = drawn != CAIRO_STATUS_SUCCESS ? drawn : status;
    throw InputError(std::string("a figure cannot be drawn: ") + cairo_status_to_string(fault));
  }
  return bytes;
}

}  // namespace fathom

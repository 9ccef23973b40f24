#include "figure_file.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>
#include <cairo.h>
#include <cmath>
#include <memory>

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

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;

cairo_status_t append(void* bytes, const unsigned char* data, unsigned int length) {
  const char* text = static_cast<const char*>(static_cast<const void*>(data));
  static_cast<std::string*>(bytes)->append(text, length);
  return CAIRO_STATUS_SUCCESS;
}

Surface surface_of(FigureFormat format, const PageSize& page, double pixels_per_point,
                   std::string& bytes) {
  const auto pixels = [&](double points) {
    return static_cast<int>(std::lround(points * pixels_per_point));
  };
  switch (format) {
    case FigureFormat::svg:
      return {cairo_svg_surface_create_for_stream(append, &bytes, page.width, page.height),
              cairo_surface_destroy};
    case FigureFormat::pdf:
      return {cairo_pdf_surface_create_for_stream(append, &bytes, page.width, page.height),
              cairo_surface_destroy};
    case FigureFormat::png:
      return {
          cairo_image_surface_create(CAIRO_FORMAT_RGB24, pixels(page.width), pixels(page.height)),
          cairo_surface_destroy};
  }
  throw InputError("a figure is SVG, PDF or PNG");
}

void require_success(cairo_status_t status) {
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw InputError(std::string("a figure cannot be drawn: ") + cairo_status_to_string(status));
}

}  // namespace

std::string render_figure(FigureFormat format, const PageSize& page,
                          const std::function<void(Canvas&)>& draw, double pixels_per_point) {
  std::string bytes;
  const Surface surface = surface_of(format, page, pixels_per_point, bytes);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()),
                                                                   cairo_destroy);
  if (format == FigureFormat::png) {
    cairo_set_source_rgb(context.get(), 1.0, 1.0, 1.0);
    cairo_paint(context.get());
    cairo_scale(context.get(), pixels_per_point, pixels_per_point);
  }
  Canvas canvas(context.get());
  draw(canvas);
  require_success(cairo_status(context.get()));
  if (format == FigureFormat::png) {
    require_success(cairo_surface_write_to_png_stream(surface.get(), append, &bytes));
  }
  cairo_surface_finish(surface.get());
  require_success(cairo_surface_status(surface.get()));
  return bytes;
}

}  // namespace fathom

#include "picture_canvas.hpp"

#include <cairo.h>
#include <memory>

#include <opencv2/imgproc.hpp>

#include "fathom/core/input_error.hpp"

namespace fathom {

cv::Mat drawn_over(const cv::Mat& bgr, const std::function<void(Canvas&)>& draw) {
  // Cairo's RGB24 has the bytes of OpenCV's BGRA on a machine that puts the low byte first.
  cv::Mat pixels;
  cv::cvtColor(bgr, pixels, cv::COLOR_BGR2BGRA);
  const std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)> surface(
      cairo_image_surface_create_for_data(pixels.data, CAIRO_FORMAT_RGB24, pixels.cols, pixels.rows,
                                          static_cast<int>(pixels.step)),
      cairo_surface_destroy);
  const std::unique_ptr<cairo_t, decltype(&cairo_destroy)> context(cairo_create(surface.get()),
                                                                   cairo_destroy);
  cairo_translate(context.get(), 0.5, 0.5);
  Canvas canvas(context.get());
  draw(canvas);
  cairo_surface_flush(surface.get());
  const cairo_status_t status = cairo_status(context.get());
  if (status != CAIRO_STATUS_SUCCESS) {
    throw InputError(std::string("a picture cannot be drawn on: ") +
                     cairo_status_to_string(status));
  }
  cv::Mat drawn;
  cv::cvtColor(pixels, drawn, cv::COLOR_BGRA2BGR);
  return drawn;
}

}  // namespace fathom

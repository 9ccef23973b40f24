#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/report/palette.hpp"

using cairo_t = struct _cairo;

namespace fathom {

enum class FigureFormat { svg, pdf };
enum class TextAlign { left, centre, right };

struct Box {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;

  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

struct Pen {
  Colour colour;
  double width = 1.0;
  std::vector<double> dashes;  ///< lengths on and off; empty: solid
  double opacity = 1.0;
};

/// A page of vectors, in points (1/72 inch) from its upper left corner, y down.
class VectorCanvas {
 public:
  explicit VectorCanvas(cairo_t* context) : context_(context) {}

  void line(std::span<const Eigen::Vector2d> points, const Pen& pen);
  void area(std::span<const Eigen::Vector2d> outline, Colour colour, double opacity);
  void disc(const Eigen::Vector2d& centre, double radius, Colour colour);
  void ring(const Eigen::Vector2d& centre, double radius, const Pen& pen);
  /// `at` is on the baseline; `upwards` turns the text to read from below.
  void text(const std::string& text, const Eigen::Vector2d& at, double size, Colour colour,
            TextAlign align = TextAlign::left, bool upwards = false);
  double text_width(const std::string& text, double size);
  /// What `draw` draws, cut off at the box.
  void clipped(const Box& box, const std::function<void()>& draw);

 private:
  cairo_t* context_;
};

/// The bytes of a file with what `draw` draws on a page of that size. Throws InputError if they
/// cannot be made.
std::string render_figure(FigureFormat format, double width, double height,
                          const std::function<void(VectorCanvas&)>& draw);

}  // namespace fathom

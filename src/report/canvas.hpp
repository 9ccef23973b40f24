#pragma once

#include <functional>
#include <span>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "fathom/report/palette.hpp"
#include "page_box.hpp"

// NOLINTNEXTLINE(bugprone-reserved-identifier): the name is cairo's
using cairo_t = struct _cairo;

namespace fathom {

enum class TextAlign { left, centre, right };

struct Pen {
  Colour colour;
  double width = 1.0;
  std::vector<double> dashes;  ///< lengths on and off; empty: solid
  double opacity = 1.0;
  double dash_offset = 0.0;  ///< where in `dashes` a line begins
};

struct TextStyle {
  double size = 7.5;
  Colour colour = palette::black;
  TextAlign align = TextAlign::left;
  bool upwards = false;  ///< turned to read from below
};

/// A text and the box of its ink.
struct PlacedText {
  std::string text;
  Box box;
};

/// What all charts, figures and marks are drawn on, in points (1/72 inch) from the upper left
/// corner, y down. Points must be finite; they may lie as far off the page as doubles go.
class Canvas {
 public:
  explicit Canvas(cairo_t* context) : context_(context) {}

  void line(std::span<const Eigen::Vector2d> points, const Pen& pen);
  void line(const Eigen::Vector2d& from, const Eigen::Vector2d& to, const Pen& pen);
  /// An area, or its outline.
  void area(std::span<const Eigen::Vector2d> outline, Colour colour, double opacity = 1.0);
  void outline(std::vector<Eigen::Vector2d> corners, const Pen& pen);
  void disc(const Eigen::Vector2d& centre, double radius, Colour colour);
  void ring(const Eigen::Vector2d& centre, double radius, const Pen& pen);
  void square(const Eigen::Vector2d& centre, double half, Colour colour);
  /// `at` is on the baseline. Control characters are drawn as blanks.
  void text(const std::string& text, const Eigen::Vector2d& at, const TextStyle& style);
  /// What `draw` draws, clipped to the box.
  void clipped(const Box& box, const std::function<void()>& draw);

  /// All texts drawn so far: what a layout is checked by.
  const std::vector<PlacedText>& texts() const { return texts_; }

 private:
  void stroke(const Pen& pen);

  cairo_t* context_;
  std::vector<PlacedText> texts_;
};

}  // namespace fathom

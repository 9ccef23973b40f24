#pragma once

#include <algorithm>

#include <Eigen/Core>

namespace fathom {

/// A rectangle of a page, in points from its upper left corner, y down.
struct Box {
  double left = 0.0;
  double top = 0.0;
  double width = 0.0;
  double height = 0.0;

  double right() const { return left + width; }
  double bottom() const { return top + height; }
  Eigen::Vector2d middle() const { return {left + 0.5 * width, top + 0.5 * height}; }
};

inline Box intersection(const Box& a, const Box& b) {
  const double left = std::max(a.left, b.left);
  const double top = std::max(a.top, b.top);
  return {left, top, std::min(a.right(), b.right()) - left, std::min(a.bottom(), b.bottom()) - top};
}

inline bool overlap(const Box& a, const Box& b) {
  return a.left < b.right() && b.left < a.right() && a.top < b.bottom() && b.top < a.bottom();
}

}  // namespace fathom

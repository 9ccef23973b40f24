#include "study_styles.hpp"

#include <array>

namespace fathom {
namespace {

constexpr double kDiscRadius = 3.0;

}  // namespace

std::map<std::string, LineStyle> line_styles(const StudyDescription& study) {
  std::map<std::string, LineStyle> styles{{kDeadReckoning, dead_reckoning_style()}};
  for (std::size_t place = 0; place < study.estimators.size(); ++place) {
    styles[study.estimators[place].name] = estimator_style(place);
  }
  return styles;
}

Pen pen_of(const LineStyle& style, double width) {
  return {style.colour, width, style.dashes, 1.0};
}

void draw_mark(Canvas& canvas, const Eigen::Vector2d& centre, const LineStyle& style) {
  using Point = Eigen::Vector2d;
  constexpr double r = 1.25 * kDiscRadius;  // of corners
  switch (style.mark) {
    case Mark::disc:
      canvas.disc(centre, kDiscRadius, style.colour);
      break;
    case Mark::square:
      canvas.square(centre, 0.9 * kDiscRadius, style.colour);
      break;
    case Mark::diamond:
      canvas.area(std::array{Point(centre + Point(0.0, -r)), Point(centre + Point(r, 0.0)),
                             Point(centre + Point(0.0, r)), Point(centre + Point(-r, 0.0))},
                  style.colour);
      break;
    case Mark::triangle:
      canvas.area(std::array{Point(centre + Point(0.0, -r)), Point(centre + Point(r, 0.8 * r)),
                             Point(centre + Point(-r, 0.8 * r))},
                  style.colour);
      break;
  }
}

}  // namespace fathom

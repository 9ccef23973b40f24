#include "study_styles.hpp"

namespace fathom {

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

}  // namespace fathom

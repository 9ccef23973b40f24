#pragma once

#include <map>
#include <string>

#include "fathom/report/palette.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// How an estimator is drawn, the same in every chart and figure of a study.
struct LineStyle {
  Colour colour;
  bool dashed = false;  ///< where there are more estimators than colours
};

/// By estimator, dead reckoning included: its own colour of the palette, by its name or else its
/// type, as long as no estimator before it has taken that; otherwise the first that is left.
std::map<std::string, LineStyle> line_styles(const StudyDescription& study);

}  // namespace fathom

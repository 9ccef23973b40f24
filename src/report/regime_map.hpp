#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "fathom/report/palette.hpp"
#include "study_results.hpp"

namespace fathom {

/// Two axes of a study, across and up, at one place of every other axis.
struct RegimeMap {
  std::size_t across = 0;
  std::size_t up = 0;
  std::string others;  ///< " loops 4", empty without other axes
  /// By place across, then up; null where a cell has no runs. They belong to the results.
  std::vector<std::vector<const CellResults*>> cells;
};

/// One for each place on the axes after the first two that have several values; none with fewer.
std::vector<RegimeMap> regime_maps(const StudyResults& results);

/// What an estimator is called as good as the best one by: a mean that is worse by this share.
inline constexpr double kAsGoodAsBest = 0.05;

/// By estimator that is ranked its mean over the best one's, both over the same trials: 1 is the
/// best, 2 twice as large. Of metrics of which less is better, and a best mean above zero.
std::map<std::string, double> relative_to_best(const CellResults& cell, const std::string& metric);

/// Those whose mean is above the best one by kAsGoodAsBest of it, or by what means nothing
/// (`least_difference`), at most.
std::vector<std::string> as_good_as_best(const CellResults& cell, const std::string& metric);

/// How a square is drawn, and the text in it.
struct Shade {
  Colour fill = palette::white;
  Colour ink = palette::black;
};

/// Of an estimator that is in no comparison, and of the choice of one with a colour.
Shade shade_of_none();
Shade shade_of_choice(Colour colour);

/// By what the squares of a map are shaded.
struct SquareScale {
  bool is_relative = true;  ///< to the best of each place: of a metric that ranks, less is better
  double least = 0.0;       ///< mean of the map
  double most = 0.0;
};

/// Nothing where no estimator that is compared has the metric. All cells of a study are ranked by a
/// metric, or none.
std::optional<SquareScale> scale_over(const StudyResults& results, const RegimeMap& map,
                                      const std::string& metric);

struct RegimeSquare {
  double mean = 0.0;               ///< of a relative scale over the trials to rank by
  std::optional<double> relative;  ///< as `relative_to_best`, of a scale that is
  Shade shade;  ///< the best nearly white, ten times its mean dark; else dark is the most of the
                ///< scale
};

/// By estimator of the cell; nothing of one that is in no comparison.
std::vector<std::optional<RegimeSquare>> regime_squares(const CellResults& cell,
                                                        const std::string& metric,
                                                        const SquareScale& scale);

/// The estimator with the least mean cost of those as good as the best one, over the trials in
/// which all of these have it; nothing where there is none, or the metric has no best.
std::optional<std::string> cheapest_of_the_best(const CellResults& cell, const std::string& metric,
                                                const std::string& cost);

}  // namespace fathom

#include "regime_page.hpp"

#include "page_numbers.hpp"
#include "ranking.hpp"
#include "regime_map.hpp"
#include "study_figures.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

// The squares of one map, of every metric: into the metrics of its cells.
void add_squares(const StudyResults& results, const RegimeMap& map, Json& cells) {
  for (const std::string& metric : results.metrics) {
    const auto scale = scale_over(results, map, metric);
    if (!scale) continue;
    for (const auto& column : map.cells) {
      for (const CellResults* cell : column) {
        if (cell == nullptr) continue;
        Json& estimators =
            cells[static_cast<std::size_t>(cell - results.cells.data())]["estimators"];
        const auto squares = regime_squares(*cell, metric, *scale);
        for (std::size_t i = 0; i < squares.size(); ++i) {
          const auto& square = squares[i];
          if (!square) continue;
          const bool is_dark = square->shade.ink == palette::white;
          estimators[i]["metrics"][metric]["square"] = {hex(square->shade.fill), is_dark,
                                                        page_value(square->relative)};
        }
      }
    }
  }
}

Json choice_json(const std::string& estimator, Colour colour) {
  return {{"estimator", estimator}, {"fill", hex(shade_of_choice(colour).fill)}};
}

}  // namespace

void add_regimes(const StudyResults& results, Json& page) {
  const std::vector<RegimeMap> maps = regime_maps(results);
  if (maps.empty()) return;
  page["regimes"] = {{"across", maps.front().across},
                     {"up", maps.front().up},
                     {"none", hex(shade_of_none().fill)}};
  for (const RegimeMap& map : maps) add_squares(results, map, page["cells"]);
  const auto metric = ranking_metric(results).name;
  const auto cost = first_metric(results, true);
  if (!metric || !cost) return;
  page["regimes"]["cheapest"] = {{"metric", *metric}, {"cost", *cost}};
  const auto styles = line_styles(results.study);
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    if (const auto choice = cheapest_of_the_best(results.cells[i], *metric, *cost)) {
      page["cells"][i]["cheapest"] = choice_json(*choice, styles.at(*choice).colour);
    }
  }
}

}  // namespace fathom

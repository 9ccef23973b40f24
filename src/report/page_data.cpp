#include "page_data.hpp"

#include <algorithm>
#include <cmath>

#include "example_page.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "honesty_words.hpp"
#include "page_numbers.hpp"
#include "regime_map.hpp"
#include "scaled_unit.hpp"
#include "study_figures.hpp"
#include "study_styles.hpp"
#include "verdict_page.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

// Keyframes of one list over all cells and estimators together: what keeps the page at a few MB.
constexpr std::size_t kKeyframesInAll = 24000;
// The same of the loops that maps show.
constexpr std::size_t kLoopsInAll = 20000;
// And of the absolute measurements.
constexpr std::size_t kAbsoluteInAll = 10000;
constexpr std::size_t kFewestKeyframes = 120;

Json metric_json(const MetricSummary& summary) {
  const Moments& moments = summary.moments;
  Json json{{"surveys", summary.surveys},
            {"n", moments.count},
            {"mean", page_number(moments.mean)}};
  if (moments.standard_deviation) json["sd"] = page_number(*moments.standard_deviation);
  if (summary.interval) {
    json["low"] = page_number(summary.interval->low);
    json["high"] = page_number(summary.interval->high);
  }
  const BandedMean band = banded(moments.mean, moments.standard_deviation);
  json["band"] = {page_number(band.low), page_number(band.high)};
  return json;
}

// Of the estimator with the most independent draws.
Json nees_interval_json(const NeesChart& chart, std::size_t most) {
  Json json{{"draws", chart.draws}, {"keyframe", Json::array()}};
  json["low"] = json["high"] = Json::array();
  if (chart.low.empty()) return json;
  // At the keyframes of the lines.
  std::size_t i = 0;
  for (const std::size_t k : thinned(static_cast<std::size_t>(chart.low.back().x()) + 1, most)) {
    while (chart.low[i].x() < static_cast<double>(k)) ++i;
    if (chart.low[i].x() > static_cast<double>(k)) continue;
    json["keyframe"].push_back(k);
    json["low"].push_back(page_number(chart.low[i].y()));
    json["high"].push_back(page_number(chart.high[i].y()));
  }
  return json;
}

Json keyframes_json(const KeyframeStatistics& all, std::size_t most) {
  const std::vector<std::size_t> places = thinned(all.keyframe.size(), most);
  Json json{{"keyframe", picked(all.keyframe, places)}, {"n", picked(all.count, places)}};
  json["mean_m"] = page_numbers(picked(all.mean_m, places));
  json["low_m"] = json["high_m"] = Json::array();
  for (const std::size_t k : places) {
    const auto band =
        all.mean_m[k] ? std::optional(banded(*all.mean_m[k], all.sd_m[k])) : std::nullopt;
    json["low_m"].push_back(band ? page_number(band->low) : Json());
    json["high_m"].push_back(band ? page_number(band->high) : Json());
  }
  json["empirical_m"] = page_numbers(picked(all.empirical_m, places));
  json["estimated_m"] = page_numbers(picked(all.estimated_m, places));
  json["anees"] = page_numbers(picked(all.anees, places));
  json["nees_n"] = picked(all.nees_count, places);
  json["nees_draws"] = picked(all.nees_draws, places);
  return json;
}

Json updates_json(const UpdateCost& cost, std::size_t most) {
  const std::vector<std::size_t> places = thinned(cost.keyframe.size(), most);
  return {{"keyframe", picked(cost.keyframe, places)},
          {"n", picked(cost.count, places)},
          {"median_ms", page_numbers(picked(cost.median_ms, places))}};
}

Json estimator_json(const EstimatorResults& one, const EstimatorSeries& series,
                    const StudyDescription& study, std::size_t most) {
  Json json{{"name", one.name},           {"runs", one.runs.size()},
            {"done", one.done},           {"outcome_text", outcome_text(one, study)},
            {"outcomes", Json::object()}, {"words", honesty_words(one)}};
  for (const auto& [name, count] : outcome_counts(one, study)) json["outcomes"][name] = count;
  json["metrics"] = Json::object();
  for (const auto& [metric, summary] : one.metrics) json["metrics"][metric] = metric_json(summary);
  json["keyframes"] = keyframes_json(series.keyframes, most);
  if (series.bounds) {
    json["bounds"] = {{"empirical_m", page_number(series.bounds->empirical_m)},
                      {"estimated_m", page_number(series.bounds->estimated_m)}};
  }
  json["updates"] = updates_json(series.updates, most);
  return json;
}

Json paired_json(const PairedResult& paired) {
  const PairedDifference& difference = paired.difference;
  Json json{{"estimator", paired.estimator},
            {"metric", paired.metric},
            {"n", difference.count},
            {"over", difference.is_over_surveys ? "surveys" : "trials"},
            {"mean", page_number(difference.mean)}};
  if (difference.interval) {
    json["low"] = page_number(difference.interval->low);
    json["high"] = page_number(difference.interval->high);
  }
  if (paired.holm_p) {
    json["p"] = page_number(*difference.signed_rank.p_value);
    json["holm_p"] = page_number(*paired.holm_p);
  }
  return json;
}

Json cell_json(const ChartInput& input, std::size_t place, const ExampleLimits& limits) {
  const StudyDescription& study = input.results.study;
  const CellResults& cell = input.results.cells[place];
  const std::vector<EstimatorSeries>& series = input.series[place];
  Json json{{"cell", cell.cell},
            {"label", cell.label},
            {"caption", cell_caption(cell)},
            {"places", study.places_of(cell.cell)},
            {"association", cell.association},
            {"selected_by", cell.selected_by},
            {"alignment", cell.alignment},
            {"jobs", counts_text(cell.jobs)},
            {"surveys", cell.surveys},
            {"n", cell.trials},
            {"repeats", cell.repeats},
            {"limits", limits_text(cell)}};
  json["estimators"] = Json::array();
  for (std::size_t i = 0; i < cell.estimators.size(); ++i) {
    json["estimators"].push_back(
        estimator_json(cell.estimators[i], series[i], study, limits.keyframes));
  }
  for (const std::string& metric : input.results.metrics) {
    const auto ranks = ranks_of(cell, metric);
    for (Json& one : json["estimators"]) {
      const auto rank = ranks.find(one["name"].get_ref<const std::string&>());
      if (rank != ranks.end()) one["metrics"][metric]["rank"] = rank->second;
    }
  }
  json["nees_interval"] = nees_interval_json(nees_chart(cell, series), limits.keyframes);
  json["paired"] = Json::array();
  for (const PairedResult& one : cell.paired) json["paired"].push_back(paired_json(one));
  json["example"] = example_json(input.examples[place], cell, limits);
  return json;
}

// The squares of one map, of every metric: into the metrics of its cells.
void add_squares(const StudyResults& results, const RegimeMap& map, Json& cells) {
  for (const std::string& metric : results.metrics) {
    const auto range = range_over(map, metric);
    if (!range) continue;
    for (const auto& column : map.cells) {
      for (const CellResults* cell : column) {
        if (cell == nullptr) continue;
        Json& estimators =
            cells[static_cast<std::size_t>(cell - results.cells.data())]["estimators"];
        for (std::size_t i = 0; i < cell->estimators.size(); ++i) {
          const auto square = regime_square(*cell, cell->estimators[i], metric, *range);
          if (!square) continue;
          const bool is_dark = square->shade.ink == palette::white;
          estimators[i]["metrics"][metric]["square"] = {hex(square->shade.fill), is_dark,
                                                        page_number(square->relative)};
        }
      }
    }
  }
}

Json choice_json(const std::string& estimator, Colour colour) {
  return {{"estimator", estimator}, {"fill", hex(shade_of_choice(colour).fill)}};
}

// The maps over two axes, and which estimator is the cheapest of the best, by cell.
void add_regimes(const StudyResults& results, Json& json) {
  const std::vector<RegimeMap> maps = regime_maps(results);
  if (maps.empty()) return;
  json["regimes"] = {{"across", maps.front().across},
                     {"up", maps.front().up},
                     {"none", hex(shade_of_none().fill)}};
  for (const RegimeMap& map : maps) add_squares(results, map, json["cells"]);
  const auto metric = first_metric(results, false);
  const auto cost = first_metric(results, true);
  if (!metric || !cost) return;
  json["regimes"]["cheapest"] = {{"metric", *metric}, {"cost", *cost}};
  const auto styles = line_styles(results.study);
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    if (const auto choice = cheapest_of_the_best(results.cells[i], *metric, *cost)) {
      json["cells"][i]["cheapest"] = choice_json(*choice, styles.at(*choice).colour);
    }
  }
}

Json study_json(const StudyDescription& study) {
  Json json{{"title", study.title}, {"surveys", study.surveys}, {"trials", study.trials}};
  json["axes"] = Json::array();
  for (const StudyAxis& axis : study.axes) {
    const auto positions = numeric_positions(axis.labels);
    json["axes"].push_back({{"name", axis.name},
                            {"key", axis.key},
                            {"labels", axis.labels},
                            {"positions", positions ? Json(*positions) : Json()}});
  }
  const auto styles = line_styles(study);
  const auto entry = [&styles](const std::string& name, const std::string& type) {
    const LineStyle& style = styles.at(name);
    return Json{{"name", name},
                {"label", display_name(name)},
                {"type", type},
                {"colour", hex(style.colour)},
                {"dashes", style.dashes}};
  };
  json["estimators"] = Json::array({entry(kDeadReckoning, "")});
  for (const auto& [name, type] : study.estimators) json["estimators"].push_back(entry(name, type));
  json["study_metrics"] = study.metrics;
  return json;
}

// What charts show first: the study's own metric, or the first that occurs of some.
std::string metric_shown_first(const StudyResults& results, bool cost,
                               const std::vector<std::string>& others) {
  if (const auto own = first_metric(results, cost)) return *own;
  for (const std::string& name : others) {
    if (std::ranges::find(results.metrics, name) != results.metrics.end()) return name;
  }
  return results.metrics.empty() ? "" : results.metrics.front();
}

// In which unit a value of a metric reads best, by its magnitude: [least, text, factor].
Json units_json(const std::vector<std::string>& units) {
  Json json = Json::object();
  for (const std::string& unit : units) {
    for (const UnitStep& step : reading_units(unit)) {
      json[unit].push_back({step.least, step.unit.text, step.unit.factor});
    }
  }
  return json;
}

const char* better_text(Better better) {
  switch (better) {
    case Better::lower:
      return "lower";
    case Better::higher:
      return "higher";
    case Better::neither:
      break;
  }
  return "neither";
}

// As JSON where it is JSON, else as the text that it is.
Json manifest_of(const std::string& text) {
  const Json parsed = Json::parse(text, nullptr, false);
  return parsed.is_discarded() ? Json(text) : parsed;
}

}  // namespace

Json page_number(double value) {
  if (!std::isfinite(value)) return {};
  const double rounded = six_digits(value);
  // Whole numbers without ".0".
  const bool whole = std::abs(rounded) < 1e6 && rounded == std::floor(rounded);
  return whole ? Json(static_cast<int>(rounded)) : Json(rounded);
}

Json page_data(const ResultStore& store, const ChartInput& input) {
  const StudyResults& results = input.results;
  const StudyDescription& study = results.study;
  const std::size_t lists = results.cells.size() * (study.estimators.size() + 1);
  const auto share_of = [lists](std::size_t in_all) {
    return std::max(kFewestKeyframes, in_all / lists);
  };
  const ExampleLimits limits{share_of(kKeyframesInAll), share_of(kLoopsInAll),
                             share_of(kAbsoluteInAll)};
  Json json = study_json(study);
  json["metrics"] = Json::object();
  json["units"] = units_json({"m", "ms", ""});
  for (const std::string& name : results.metrics) {
    const Metric metric = described(name);
    json["metrics"][name] = {{"label", metric.label_with_unit()},
                             {"title", metric.label},
                             {"unit", metric.unit},
                             {"cost", metric.is_cost},
                             {"better", better_text(metric.better)}};
    json["units"].update(units_json({metric.unit}));
  }
  json["fates"] = fates_json();
  json["first"] = {
      {"accuracy", metric_shown_first(results, false, {"mean_position_error_m", "chi2"})},
      {"cost", metric_shown_first(results, true,
                                  {"total_ms", "update_ms.median", "cpu_ms", "memory_bytes"})}};
  json["intervals"] = intervals_text(results);
  json["cells"] = Json::array();
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    json["cells"].push_back(cell_json(input, i, limits));
  }
  add_regimes(results, json);
  add_verdict(results, json);
  json["configuration"] = Json::object();
  for (const auto& [key, value] : study.configuration) json["configuration"][key] = value;
  json["manifests"] = Json::array();
  for (const std::string& text : store.manifests()) json["manifests"].push_back(manifest_of(text));
  return json;
}

}  // namespace fathom

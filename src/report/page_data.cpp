#include "page_data.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

#include "example_trial.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "honesty_words.hpp"
#include "page_numbers.hpp"
#include "regime_map.hpp"
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
constexpr double kBoundsProbability = 0.95;

Json metric_json(const MetricSummary& summary) {
  const Moments& moments = summary.moments;
  Json json{{"surveys", summary.surveys},
            {"n", moments.count},
            {"mean", page_number(moments.mean)},
            {"median", page_number(moments.median)}};
  if (moments.standard_deviation) json["sd"] = page_number(*moments.standard_deviation);
  if (summary.interval) {
    json["low"] = page_number(summary.interval->low);
    json["high"] = page_number(summary.interval->high);
  }
  return json;
}

Json nees_interval_json(const std::vector<std::size_t>& counts) {
  Json low = Json::array();
  Json high = Json::array();
  for (const std::size_t count : counts) {
    const bool known = count > 0;
    const Interval interval = anees_interval(known ? count : 1, 3, kBoundsProbability);
    low.push_back(known ? page_number(interval.low) : Json());
    high.push_back(known ? page_number(interval.high) : Json());
  }
  return {{"low", low}, {"high", high}};
}

Json keyframes_json(const KeyframeStatistics& all, std::size_t most) {
  const std::vector<std::size_t> places = thinned(all.keyframe.size(), most);
  const std::vector<std::size_t> draws = picked(all.nees_draws, places);
  Json json{{"keyframe", picked(all.keyframe, places)}, {"n", picked(all.count, places)}};
  json["mean_m"] = page_numbers(picked(all.mean_m, places));
  json["sd_m"] = page_numbers(picked(all.sd_m, places));
  json["empirical_m"] = page_numbers(picked(all.empirical_m, places));
  json["estimated_m"] = page_numbers(picked(all.estimated_m, places));
  json["anees"] = page_numbers(picked(all.anees, places));
  json["nees_n"] = picked(all.nees_count, places);
  json["nees_draws"] = draws;
  json["nees_interval"] = nees_interval_json(draws);
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
  Json json{{"name", one.name},         {"runs", one.runs.size()},
            {"done", one.done},         {"outcome_text", outcome_text(one, study)},
            {"outcomes", one.outcomes}, {"words", honesty_words(one)}};
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

Json cell_json(const ResultStore& store, const CellResults& cell,
               const std::vector<EstimatorSeries>& series, const StudyDescription& study,
               const ExampleLimits& limits) {
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
  json["paired"] = Json::array();
  for (const PairedResult& one : cell.paired) json["paired"].push_back(paired_json(one));
  json["example"] = example_trial(store, cell, limits);
  return json;
}

// Which is the cheapest of the best, by cell; what the page's regime map shows.
void add_regimes(const StudyResults& results, Json& json) {
  const auto metric = first_metric(results, false);
  const auto cost = first_metric(results, true);
  if (!metric || !cost || regime_maps(results).empty()) return;
  json["regimes"] = {{"metric", *metric}, {"cost", *cost}};
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    if (const auto choice = cheapest_of_the_best(results.cells[i], *metric, *cost)) {
      json["cells"][i]["cheapest"] = *choice;
    }
  }
}

Json study_json(const StudyDescription& study) {
  Json json{{"title", study.title}, {"surveys", study.surveys}, {"trials", study.trials}};
  json["axes"] = Json::array();
  for (const StudyAxis& axis : study.axes) {
    json["axes"].push_back({{"name", axis.name}, {"key", axis.key}, {"labels", axis.labels}});
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
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.6g", value);
  const double rounded = std::strtod(buffer, nullptr);
  // Whole numbers without ".0".
  const bool whole = std::abs(rounded) < 1e6 && rounded == std::floor(rounded);
  return whole ? Json(static_cast<int>(rounded)) : Json(rounded);
}

Json page_data(const ResultStore& store, const StudyResults& results,
               const std::vector<std::vector<EstimatorSeries>>& series) {
  const StudyDescription& study = results.study;
  const std::size_t lists = results.cells.size() * (study.estimators.size() + 1);
  const auto share_of = [lists](std::size_t in_all) {
    return std::max(kFewestKeyframes, in_all / lists);
  };
  const ExampleLimits limits{share_of(kKeyframesInAll), share_of(kLoopsInAll),
                             share_of(kAbsoluteInAll)};
  Json json = study_json(study);
  json["metrics"] = Json::object();
  for (const std::string& name : results.metrics) {
    const Metric metric = described(name);
    json["metrics"][name] = {{"label", metric.label_with_unit()},
                             {"title", metric.label},
                             {"unit", metric.unit},
                             {"cost", metric.is_cost},
                             {"better", better_text(metric.better)}};
  }
  json["intervals"] = intervals_text(results);
  json["cells"] = Json::array();
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    json["cells"].push_back(cell_json(store, results.cells[i], series[i], study, limits));
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

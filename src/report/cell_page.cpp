#include "cell_page.hpp"

#include <cmath>

#include "contenders.hpp"
#include "honesty_words.hpp"
#include "page_numbers.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

Json metric_json(const MetricSummary& summary) {
  const Moments& moments = summary.moments;
  Json json{{"surveys", summary.surveys}, {"n", moments.count}, {"mean", page_value(moments.mean)}};
  if (moments.standard_deviation) json["sd"] = page_value(*moments.standard_deviation);
  if (summary.interval) {
    json["low"] = page_value(summary.interval->low);
    json["high"] = page_value(summary.interval->high);
  }
  const BandedMean band = banded(moments.mean, moments.standard_deviation);
  json["band"] = {page_number(band.low), page_number(band.high)};
  return json;
}

// Ranks of a metric, and where they are of other trials than an estimator's own mean that over
// these.
void add_ranks(const CellResults& cell, const std::string& metric, Json& estimators) {
  const auto ranks = ranks_of(cell, metric);
  const std::set<TrialKey> trials = contenders_of(cell, metric).trials;
  for (std::size_t i = 0; i < cell.estimators.size(); ++i) {
    const auto rank = ranks.find(cell.estimators[i].name);
    if (rank == ranks.end()) continue;
    Json& json = estimators[i]["metrics"][metric];
    json["rank"] = rank->second;
    if (json["n"] != trials.size()) {
      json["ranked"] = metric_json(summary_over(cell.estimators[i], metric, trials));
    }
  }
}

// Of the estimator with the most independent draws.
Json nees_interval_json(const NeesChart& chart, std::size_t most) {
  Json json{{"draws", chart.draws}, {"keyframe", Json::array()}};
  json["low"] = json["high"] = Json::array();
  // At the keyframes of the lines.
  std::size_t i = 0;
  for (const std::size_t k : thinned(chart.keyframes, most)) {
    while (i < chart.low.size() && chart.low[i].x() < static_cast<double>(k)) ++i;
    if (i == chart.low.size() || chart.low[i].x() > static_cast<double>(k)) continue;
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
    const auto& mean = all.mean_m[k];
    const BandedMean band = mean ? banded(*mean, all.sd_m[k]) : BandedMean{NAN, NAN, NAN};
    json["low_m"].push_back(page_number(band.low));
    json["high_m"].push_back(page_number(band.high));
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
  // A line goes through keyframes that all had an update, also where some of them are thinned out.
  Json pieces = Json::array();
  std::size_t piece = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (i > 0 &&
        cost.keyframe[places[i]] - cost.keyframe[places[i - 1]] != places[i] - places[i - 1]) {
      ++piece;
    }
    pieces.push_back(piece);
  }
  return {{"keyframe", picked(cost.keyframe, places)},
          {"piece", pieces},
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
    json["bounds"] = {{"empirical_m", page_value(series.bounds->empirical_m)},
                      {"estimated_m", page_value(series.bounds->estimated_m)}};
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
            {"mean", page_value(difference.mean)}};
  if (difference.interval) {
    json["low"] = page_value(difference.interval->low);
    json["high"] = page_value(difference.interval->high);
  }
  if (paired.holm_p) {
    json["p"] = page_value(*difference.signed_rank.p_value);
    json["holm_p"] = page_value(*paired.holm_p);
  }
  return json;
}

}  // namespace

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
  json["unranked"] = Json::object();
  for (const std::string& metric : input.results.metrics) {
    const std::string against = no_ranking_text(cell, metric);
    if (!against.empty()) json["unranked"][metric] = against;
    add_ranks(cell, metric, json["estimators"]);
  }
  json["nees_interval"] = nees_interval_json(nees_chart(cell, series), limits.keyframes);
  json["paired"] = Json::array();
  for (const PairedResult& one : cell.paired) json["paired"].push_back(paired_json(one));
  json["example"] = example_json(input.examples[place], cell, limits);
  return json;
}

}  // namespace fathom

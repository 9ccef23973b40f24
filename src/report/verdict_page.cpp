#include "verdict_page.hpp"

#include "page_numbers.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

// Beside the best; empty where there is no interval.
const char* standing_text(const RankedEstimator& one) {
  if (!one.difference || !one.difference->interval) return "";
  switch (one.standing) {
    case Standing::best:
      return "best";
    case Standing::equivalent:
      return "equivalent";
    case Standing::worse:
      return "worse";
    case Standing::not_shown:
      break;
  }
  return "not_shown";
}

Json ranking_json(const Ranking& ranking) {
  Json json{{"best", ranking.best().name},
            {"level", page_value(ranking.level)},
            {"margin", page_value(ranking.margin)}};
  json["others"] = Json::array();
  for (const RankedEstimator& one : ranking.estimators) {
    if (&one == &ranking.best()) continue;
    Json other{{"estimator", one.name}, {"standing", standing_text(one)}};
    if (const auto& difference = one.difference) {
      other["n"] = difference->count;
      other["over"] = difference->is_over_surveys ? "surveys" : "trials";
      other["mean"] = page_value(difference->mean);
      if (difference->interval) {
        other["low"] = page_value(difference->interval->low);
        other["high"] = page_value(difference->interval->high);
      }
    }
    if (one.p) other["p"] = page_value(*one.p);
    json["others"].push_back(other);
  }
  return json;
}

Json cell_json(const CellVerdict& verdict) {
  Json json{{"answer", verdict.answer},
            {"cost", verdict.cost},
            {"as_cheap", verdict.as_cheap},
            {"failed", verdict.failed}};
  json["doubts"] = Json::array();
  for (const Doubt& doubt : verdict.doubts) json["doubts"].push_back(words_of(doubt));
  return json;
}

}  // namespace

void add_verdict(const StudyResults& results, Json& page) {
  const StudyVerdict verdict = study_verdict(results);
  page["verdict"] = {{"metric", verdict.metric ? Json(*verdict.metric) : Json()},
                     {"rule", verdict.rule},
                     {"answer", verdict.answer},
                     {"cost", verdict.cost_words},
                     {"failed", verdict.failed},
                     {"doubts", verdict.doubts}};
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    Json& cell = page["cells"][i];
    cell["verdict"] = cell_json(verdict.cells[i]);
    cell["rankings"] = Json::object();
    for (const std::string& metric : results.study.metrics) {
      const auto ranked = metric == verdict.metric
                              ? verdict.cells[i].ranking
                              : ranking(results.cells[i], metric, {.margin = results.study.margin});
      if (ranked) cell["rankings"][metric] = ranking_json(*ranked);
    }
  }
}

}  // namespace fathom

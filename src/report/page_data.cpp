#include "page_data.hpp"

#include <algorithm>
#include <cmath>

#include "cell_page.hpp"
#include "fathom/configuration/axis_words.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "page_numbers.hpp"
#include "regime_page.hpp"
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

// As Vega calls it.
const char* shape_of(Mark mark) {
  switch (mark) {
    case Mark::disc:
      return "circle";
    case Mark::square:
      return "square";
    case Mark::diamond:
      return "diamond";
    case Mark::triangle:
      return "triangle-up";
  }
  return "circle";
}

Json study_json(const StudyDescription& study) {
  Json json{{"title", study.title}, {"surveys", study.surveys}, {"trials", study.trials}};
  json["axes"] = Json::array();
  for (const StudyAxis& axis : study.axes) {
    const auto positions = numeric_positions(axis.labels);
    Json texts = Json::array();
    for (std::size_t i = 0; i < axis.labels.size(); ++i) texts.push_back(text_of(axis, i));
    json["axes"].push_back({{"title", title_of(axis)},
                            {"key", axis.key},
                            {"labels", axis.labels},
                            {"texts", texts},
                            {"ticks", ticks_of(axis)},
                            {"positions", positions ? Json(*positions) : Json()},
                            {"logarithmic", positions && are_geometric(*positions)}});
  }
  const auto styles = line_styles(study);
  const auto entry = [&styles](const std::string& name, const std::string& type) {
    const LineStyle& style = styles.at(name);
    return Json{{"name", name},           {"label", display_name(name)},
                {"type", type},           {"colour", hex(style.colour)},
                {"dashes", style.dashes}, {"mark", shape_of(style.mark)}};
  };
  json["estimators"] = Json::array({entry(kDeadReckoning, "")});
  for (const auto& [name, type] : study.estimators) json["estimators"].push_back(entry(name, type));
  json["study_metrics"] = study.metrics;
  return json;
}

// What charts show first: the study's own metric, or the first that occurs of some, or of all.
std::string metric_shown_first(const StudyResults& results, bool cost,
                               const std::vector<std::string>& others) {
  const auto own = cost ? first_metric(results, true) : accuracy_shown(results);
  if (own) return *own;
  for (const std::string& name : others) {
    if (std::ranges::find(results.metrics, name) != results.metrics.end()) return name;
  }
  const auto any = std::ranges::find(results.metrics, cost, is_cost_metric);
  return any == results.metrics.end() ? "" : *any;
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
  return page_value(six_digits(value));
}

Json page_value(double value) {
  if (!std::isfinite(value)) return {};
  // Whole numbers without ".0".
  const bool whole = std::abs(value) < 1e6 && value == std::floor(value);
  return whole ? Json(static_cast<int>(value)) : Json(value);
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

#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "groups.hpp"

namespace fathom {
namespace {

constexpr const char* kErrorPrefix = "rpe_";

// Of one separation or distance, a number as text: its translation and its rotation.
struct Kind {
  const char* infix;  ///< between the number and the unit of the error
  const char* over;   ///< "keyframes"
  const char* key;    ///< of the configuration
  std::optional<RelativeError> (*error)(const RunFacts&, double);
};

const Kind kOverKeyframes{"_keyframes_", "keyframes", "evaluation.rpe_keyframes",
                          [](const RunFacts& facts, double keyframes) {
                            return relative_error(facts.estimate, *facts.ground_truth,
                                                  static_cast<std::size_t>(keyframes));
                          }};
const Kind kOverDistance{
    "_m_", "m", "evaluation.rpe_distances_m", [](const RunFacts& facts, double distance_m) {
      return relative_error_over(facts.estimate, *facts.ground_truth, distance_m);
    }};

std::string text_over(const Kind& kind, const std::string& number) {
  const bool is_one = number == "1" && &kind == &kOverKeyframes;
  return number + " " + (is_one ? "keyframe" : kind.over);
}

Metric member(const Kind& kind, const std::string& number, const std::string& unit) {
  const bool is_translation = unit == "m";
  Metric metric;
  metric.name = kErrorPrefix + number + kind.infix + unit;
  metric.label = "RPE over " + text_over(kind, number);
  metric.unit = unit;
  metric.better = Better::lower;
  metric.description =
      fmt::format("relative error (RMSE) of the {} over {} ({})",
                  is_translation ? "translation" : "rotation", text_over(kind, number), kind.key);
  const double over = parse_real(number).value_or(0.0);
  const auto field =
      is_translation ? &RelativeError::translation_rmse_m : &RelativeError::rotation_rmse_rad;
  metric.value = [error = kind.error, over, field](const JudgedRun& run) -> std::optional<double> {
    if (!run.facts.ground_truth || !(over > 0.0)) return std::nullopt;
    const auto relative = error(run.facts, over);
    if (!relative) return std::nullopt;
    return (*relative).*field;
  };
  return metric;
}

}  // namespace

std::vector<Metric> relative_error_metrics(const std::vector<std::string>& keyframes,
                                           const std::vector<std::string>& distances_m) {
  std::vector<Metric> metrics;
  for (const char* unit : {"m", "rad"}) {
    for (const std::string& number : keyframes) {
      metrics.push_back(member(kOverKeyframes, number, unit));
    }
    for (const std::string& number : distances_m) {
      metrics.push_back(member(kOverDistance, number, unit));
    }
  }
  return metrics;
}

std::optional<Metric> relative_error_metric(const std::string& name) {
  if (!name.starts_with(kErrorPrefix)) return std::nullopt;
  for (const Kind* kind : {&kOverKeyframes, &kOverDistance}) {
    for (const std::string unit : {"m", "rad"}) {
      const std::string ending = kind->infix + unit;
      const std::size_t begin = std::string(kErrorPrefix).size();
      if (!name.ends_with(ending) || name.size() <= begin + ending.size()) continue;
      const std::string number = name.substr(begin, name.size() - begin - ending.size());
      const auto over = parse_real(number);
      if (over && *over > 0.0) return member(*kind, number, unit);
    }
  }
  return std::nullopt;
}

}  // namespace fathom

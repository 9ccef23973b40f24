// NEES without keyframe 0 as the only one held: of motions over given stretches, and with several
// keyframes held in turn.

#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "groups.hpp"

namespace fathom {
namespace {

constexpr const char* kAneesPrefix = "relative_anees_";

std::optional<double> value_over(const JudgedRun& run, MotionsOver over,
                                 std::optional<double> amount) {
  if (!run.facts.ground_truth) return std::nullopt;
  for (const JudgedMotions& motions : run.facts.motions) {
    if (motions.over != over || (amount && motions.amount != *amount)) continue;
    return relative_anees(run.facts.estimate, *run.facts.ground_truth, motions);
  }
  return std::nullopt;
}

Metric member(MotionsOver over, const std::string& number) {
  const bool is_keyframes = over == MotionsOver::keyframes;
  const std::string stretch = number + (!is_keyframes   ? " m"
                                        : number == "1" ? " keyframe"
                                                        : " keyframes");
  Metric metric;
  metric.name = kAneesPrefix + number + (is_keyframes ? "_keyframes" : "_m");
  metric.label = "ANEES over " + stretch;
  metric.description = fmt::format(
      "mean NEES of the motions over {}, divided by 3; 1 expected, above: overconfident ({})",
      stretch, is_keyframes ? "evaluation.rpe_keyframes" : "evaluation.rpe_distances_m");
  const std::optional<double> amount = parse_real(number);
  metric.value = [over, amount](const JudgedRun& run) -> std::optional<double> {
    return amount ? value_over(run, over, amount) : std::nullopt;
  };
  return metric;
}

}  // namespace

Metric anchored_anees_metric() {
  return {"anchored_anees",
          "anchored ANEES",
          "",
          Better::neither,
          "ANEES with several keyframes held in turn instead of keyframe 0; 1 expected",
          [](const JudgedRun& run) { return value_over(run, MotionsOver::anchors, std::nullopt); }};
}

std::vector<Metric> relative_consistency_metrics(const std::vector<std::string>& keyframes,
                                                 const std::vector<std::string>& distances_m) {
  std::vector<Metric> metrics;
  metrics.reserve(keyframes.size() + distances_m.size());
  for (const std::string& number : keyframes) {
    metrics.push_back(member(MotionsOver::keyframes, number));
  }
  for (const std::string& number : distances_m) {
    metrics.push_back(member(MotionsOver::distance_m, number));
  }
  return metrics;
}

std::optional<Metric> relative_consistency_metric(const std::string& name) {
  if (!name.starts_with(kAneesPrefix)) return std::nullopt;
  const std::size_t begin = std::string(kAneesPrefix).size();
  for (const auto& [over, ending] : {std::pair(MotionsOver::keyframes, std::string("_keyframes")),
                                     std::pair(MotionsOver::distance_m, std::string("_m"))}) {
    if (!name.ends_with(ending) || name.size() <= begin + ending.size()) continue;
    const std::string number = name.substr(begin, name.size() - begin - ending.size());
    const auto amount = parse_real(number);
    if (amount && *amount > 0.0) return member(over, number);
  }
  return std::nullopt;
}

}  // namespace fathom

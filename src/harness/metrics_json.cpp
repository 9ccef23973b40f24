#include <cmath>

#include <nlohmann/json.hpp>

#include "fathom/harness/result.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

// Counts as whole numbers, as everything that a double holds exactly and without a fraction.
Json number(double value) {
  constexpr double kLargestExact = 9007199254740992.0;  // 2^53
  if (value == std::trunc(value) && std::abs(value) <= kLargestExact) {
    return static_cast<std::int64_t>(value);
  }
  return value;
}

Json json_of(const std::map<std::string, double>& metrics) {
  Json json = Json::object();
  for (const auto& [name, value] : metrics) json[name] = number(value);
  return json;
}

Json rejected_loops(const Result& result, const std::vector<std::int64_t>& ids) {
  const auto id_of = [&ids](std::size_t k) {
    return ids.empty() ? static_cast<std::int64_t>(k) : ids[k];
  };
  Json rejected = Json::array();
  for (const LoopDecision& loop : result.run.loops) {
    if (loop.fate != LoopFate::rejected) continue;
    Json entry{{"from", id_of(loop.from)}, {"to", id_of(loop.to)}};
    if (loop.nis) entry["nis"] = *loop.nis;
    rejected.push_back(entry);
  }
  return rejected;
}

Json rejected_absolute(const Result& result, const std::vector<std::int64_t>& ids) {
  Json rejected = Json::array();
  for (const AbsoluteDecision& z : result.run.absolute) {
    if (z.fate != LoopFate::rejected) continue;
    Json entry{{"keyframe", ids.empty() ? static_cast<std::int64_t>(z.keyframe) : ids[z.keyframe]}};
    if (z.nis) entry["nis"] = *z.nis;
    rejected.push_back(entry);
  }
  return rejected;
}

Json entry_of(const Result& result, const Recording& recording) {
  Json json;
  json["estimator"] = result.estimator.type;
  json["name"] = result.estimator.name;
  json["mode"] = result.mode == SolveMode::batch ? "batch" : "incremental";
  json["outcome"] = name_of(result.run.outcome);
  if (!result.run.fault.empty()) json["fault"] = result.run.fault;
  for (std::size_t i = 0; i < result.run.outcome_counts.size(); ++i) {
    json["outcome_counts"][name_of(static_cast<Outcome>(i))] = result.run.outcome_counts[i];
  }
  if (result.accuracy) json["alignment"] = name_of(result.accuracy->alignment);
  json.update(json_of(result.metrics));
  if (result.accuracy) {
    json["dead_reckoning"] = json_of(dead_reckoning_metrics(recording, result.options));
  }
  json["rejected_loops"] = rejected_loops(result, recording.log.ids);
  if (!result.run.absolute.empty()) {
    json["rejected_absolute"] = rejected_absolute(result, recording.log.ids);
  }
  return json;
}

}  // namespace

std::string metrics_json(const Result& result, const Recording& recording) {
  return entry_of(result, recording).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string comparison_json(const std::vector<Result>& results, const Recording& recording) {
  Json list = Json::array();
  for (const Result& result : results) list.push_back(entry_of(result, recording));
  return list.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fathom

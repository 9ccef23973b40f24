#include "fathom/harness/result.hpp"

#include <cmath>

#include <nlohmann/json.hpp>

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

// JSON has no NaN and no infinity: such a number is left out.
void put(Json& json, const std::string& key, double value) {
  if (std::isfinite(value)) json[key] = value;
}

Json json_of(const Accuracy& accuracy) {
  Json json;
  put(json, "mean_position_error_m", accuracy.mean_position_error_m);
  put(json, "ate_rmse_m", accuracy.ate_rmse_m);
  put(json, "max_position_error_m", accuracy.max_position_error_m);
  put(json, "final_position_error_m", accuracy.final_position_error_m);
  put(json, "heading_rmse_rad", accuracy.heading_rmse_rad);
  return json;
}

Json json_of(const Summary& summary) {
  Json json;
  json["count"] = summary.count;
  put(json, "median", summary.median);
  put(json, "p95", summary.p95);
  put(json, "max", summary.max);
  put(json, "mean", summary.mean);
  put(json, "total", summary.total);
  return json;
}

void put_accuracy(Json& json, const Result& result, const Recording& recording) {
  if (!result.accuracy) return;
  json["alignment"] = name_of(result.accuracy->alignment);
  json.update(json_of(*result.accuracy));
  if (result.relative_error) {
    put(json, "rpe_translation_rmse_m", result.relative_error->translation_rmse_m);
    put(json, "rpe_rotation_rmse_rad", result.relative_error->rotation_rmse_rad);
  }
  if (const auto baseline = dead_reckoning_accuracy(recording, result.accuracy->alignment)) {
    json["dead_reckoning"] = json_of(*baseline);
  }
}

void put_loops(Json& json, const Result& result, const std::vector<std::int64_t>& ids) {
  const auto id_of = [&ids](std::size_t k) {
    return ids.empty() ? static_cast<std::int64_t>(k) : ids[k];
  };
  Json rejected = Json::array();
  double nis_sum = 0.0;
  std::size_t nis_count = 0;
  for (const LoopDecision& loop : result.replay.loops) {
    if (loop.fate == LoopFate::rejected) {
      Json entry{{"from", id_of(loop.from)}, {"to", id_of(loop.to)}};
      if (loop.nis) put(entry, "nis", *loop.nis);
      rejected.push_back(entry);
    } else if (loop.fate == LoopFate::used && loop.nis) {
      nis_sum += *loop.nis;
      ++nis_count;
    }
  }
  if (nis_count > 0) put(json, "mean_nis_accepted", nis_sum / static_cast<double>(nis_count));
  json["rejected_loops"] = rejected;
}

double initial_chi2(const Recording& recording, const ReplayOptions& options) {
  if (!options.start.empty()) return chi2(recording.log, options.start);
  return chi2(recording.log, recording.log.odometry());
}

Json metrics_of(const Result& result, const Recording& recording) {
  Json json;
  json["estimator"] = result.estimator.type;
  json["name"] = result.estimator.name;
  json["mode"] = result.mode == SolveMode::batch ? "batch" : "incremental";
  json["outcome"] = name_of(result.replay.outcome);
  if (!result.replay.fault.empty()) json["fault"] = result.replay.fault;
  for (std::size_t i = 0; i < result.replay.outcome_counts.size(); ++i) {
    json["outcome_counts"][name_of(static_cast<Outcome>(i))] = result.replay.outcome_counts[i];
  }
  json["iterations"] = result.replay.iterations;
  json["keyframes"] = recording.log.size();
  json["registrations"] = recording.log.registration_count();
  if (!recording.frames.empty()) {
    json["registrations_tried"] = recording.registrations_tried;
    json["registrations_left_out"] = recording.registrations_left_out;
  }
  json["loop_closures"] = result.loop_closures;
  json["rejected"] = result.rejected;
  json["lost"] = result.lost;
  json["loops_kept"] = result.loops_kept;
  if (const auto& counts = result.false_loop_counts) {
    json["false_loops"] = counts->false_loops;
    json["false_loops_kept"] = counts->false_loops_kept;
    json["right_loops_lost"] = counts->right_loops_lost;
  }
  put(json, "chi2", result.chi2);
  put(json, "chi2_initial", result.chi2_initial);
  put(json, "chi2_used", result.replay.cost_used);
  if (result.replay.gradient_norm) put(json, "gradient_norm", *result.replay.gradient_norm);
  if (result.replay.is_local_minimum) json["is_local_minimum"] = *result.replay.is_local_minimum;
  put_accuracy(json, result, recording);
  if (result.consistency) {
    put(json, "anees", result.consistency->anees);
    put(json, "position_anees", result.consistency->position_anees);
    put(json, "share_inside_2_sigma", result.consistency->share_inside_2_sigma);
  }
  json["update_ms"] = result.update_ms ? json_of(*result.update_ms) : Json{{"count", 0}};
  put(json, "total_ms", result.replay.total_ms);
  put(json, "cpu_ms", result.replay.cpu_ms);
  if (result.replay.covariances) put(json, "covariance_ms", result.replay.covariance_ms);
  if (result.replay.memory_bytes) json["memory_bytes"] = *result.replay.memory_bytes;
  put_loops(json, result, recording.log.ids);
  return json;
}

}  // namespace

Result evaluate(const Recording& recording, const EstimatorConfiguration& estimator,
                const EstimatorRegistry& registry, Alignment alignment,
                const ReplayOptions& options) {
  Result result;
  result.estimator = estimator;
  result.mode = options.mode;
  result.replay = replay(recording.log, registry.find(estimator.type), estimator.values, options);
  result.chi2 = chi2(recording.log, result.replay.trajectory);
  result.chi2_initial = initial_chi2(recording, options);
  for (const LoopDecision& loop : result.replay.loops) {
    if (loop.fate == LoopFate::used) ++result.loop_closures;
    if (loop.fate == LoopFate::rejected) ++result.rejected;
    if (loop.fate == LoopFate::lost) ++result.lost;
  }
  result.loops_kept = count_kept(result.replay.loop_weights);
  if (!recording.is_false_loop.empty()) {
    result.false_loop_counts =
        count_false_loops(result.replay.loop_weights, recording.is_false_loop);
  }
  result.update_ms = summarise(result.replay.update_ms);
  if (recording.ground_truth && recording.log.size() > 1) {
    result.accuracy = accuracy(result.replay.trajectory, *recording.ground_truth, alignment);
    result.relative_error = relative_error(result.replay.trajectory, *recording.ground_truth, 1);
    if (result.replay.covariances) {
      result.consistency = consistency(result.replay.trajectory, *recording.ground_truth,
                                       *result.replay.covariances);
    }
  }
  return result;
}

std::optional<Accuracy> dead_reckoning_accuracy(const Recording& recording, Alignment alignment) {
  if (!recording.ground_truth || recording.log.size() < 2) return std::nullopt;
  return accuracy(recording.log.odometry(), *recording.ground_truth, alignment);
}

std::string metrics_json(const Result& result, const Recording& recording) {
  return metrics_of(result, recording).dump(2) + "\n";
}

std::string comparison_json(const std::vector<Result>& results, const Recording& recording) {
  Json list = Json::array();
  for (const Result& result : results) list.push_back(metrics_of(result, recording));
  return list.dump(2) + "\n";
}

}  // namespace fathom

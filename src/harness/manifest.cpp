#include "fathom/harness/manifest.hpp"

#include <chrono>
#include <cstdio>
#include <ctime>
#include <fstream>

#include <nlohmann/json.hpp>

#include "build_info.hpp"
#include "fathom/core/hash.hpp"
#include "fathom/core/system.hpp"
#include "fathom/core/version.hpp"
#include "fathom/datasets/fingerprint.hpp"
#include "fathom/measurements/shared_file.hpp"
#include "fathom/vision/static_view.hpp"

namespace fathom {
namespace {

using Json = nlohmann::ordered_json;

std::string cpu_model() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

std::string utc_now() {
  const std::time_t now = std::chrono::system_clock::to_time_t(std::chrono::system_clock::now());
  std::tm calendar{};
  gmtime_r(&now, &calendar);
  char buffer[32];
  std::strftime(buffer, sizeof buffer, "%Y-%m-%dT%H:%M:%SZ", &calendar);
  return buffer;
}

Json build_and_machine(int jobs) {
  Json json;
  json["build"] = {{"type", FATHOM_BUILD_TYPE},     {"compiler", FATHOM_COMPILER},
                   {"flags", FATHOM_FLAGS},         {"ceres", FATHOM_CERES_VERSION},
                   {"eigen", FATHOM_EIGEN_VERSION}, {"opencv", FATHOM_OPENCV_VERSION}};
  json["machine"] = {{"cpu", cpu_model()}, {"host", host_name()}, {"jobs", jobs}};
  return json;
}

// Least, median, most over the keyframes.
Json spread(const Spread& values) {
  return Json::array({values.least, values.median, values.most});
}

Json in_metres(const FrontEndInMetres& values) {
  return {{"max_error_m", spread(values.max_error_m)},
          {"candidate_reach_m", spread(values.reach_m)},
          {"keyframe_step_m", spread(values.step_m)},
          {"keyframe_separation_frames", spread(values.separation_frames)}};
}

Json session(const std::string& command_line, int jobs) {
  Json json;
  json["fathom"] = version();
  json["command_line"] = command_line;
  json["date"] = utc_now();
  json.update(build_and_machine(jobs));
  return json;
}

}  // namespace

std::string session_json(const std::string& command_line, int jobs) {
  return session(command_line, jobs).dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string session_json(const ShardPlan& plan, int jobs) {
  Json json = session(plan.command_line, jobs);
  json["shard"] = {{"index", plan.shard.index},   {"of", plan.shard.of},
                   {"runs", plan.runs},           {"surveys", plan.range.surveys},
                   {"trials", plan.range.trials}, {"places", plan.range.places},
                   {"first", plan.range.first},   {"count", plan.range.count}};
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

std::string manifest_json(const std::string& command_line,
                          const std::vector<std::pair<std::string, std::string>>& configuration,
                          const Fingerprint& data, const Recording& recording, const Result& result,
                          const EstimatorRegistry& registry,
                          const std::vector<std::string>& remarks) {
  Json json = session(command_line, 1);
  json["data"] = {{"files", data.size()}, {"fingerprint", fingerprint_text(data)}};
  json["measurements_fnv1a64"] = hash_text(text_of(recording.log));
  for (const auto& [key, value] : configuration) json["configuration"][key] = value;
  Json options;
  for (const auto& [key, value] :
       estimator_options(result.estimator, registry.find(result.estimator.type))) {
    options[key] = value;
  }
  json["estimator"] = {{"name", result.estimator.name},
                       {"type", result.estimator.type},
                       {"mode", result.mode == SolveMode::batch ? "batch" : "incremental"},
                       {"options", options}};
  if (!recording.frames.empty()) {
    json["front_end"] = {{"frames", recording.frames.size()},
                         {"keyframes", recording.log.size()},
                         {"registrations_tried", recording.registrations_tried},
                         {"registrations_found", recording.log.registration_count()},
                         {"registrations_left_out", recording.registrations_left_out},
                         {"visual_odometry", recording.visual_odometry},
                         {"visual_odometry_failures", recording.visual_odometry_failures}};
    if (!recording.mask.empty()) {
      json["front_end"]["masked_share"] = masked_share(recording.mask);
    }
    for (const FoundSigma& sigma : recording.found_sigmas) {
      json["front_end"]["estimated"].push_back(words(sigma));
    }
    if (recording.in_metres) json["front_end"]["in_metres"] = in_metres(*recording.in_metres);
  }
  if (!remarks.empty()) json["remarks"] = remarks;
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

}  // namespace fathom

#include "fathom/harness/run_folder.hpp"

#include <nlohmann/json.hpp>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/utf8.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/graph_numbers.hpp"
#include "fathom/measurements/shared_file.hpp"

namespace fathom {
namespace {

std::vector<StampedPose> dead_reckoning(const Recording& recording) {
  if (recording.frames.empty()) return keyframe_trajectory(recording, recording.log.odometry());
  std::vector<StampedPose> trajectory;
  for (std::size_t i = 0; i < recording.frames.size(); ++i) {
    trajectory.push_back({recording.frames[i].time_ns, recording.frame_dead_reckoning[i]});
  }
  return trajectory;
}

std::vector<StampedPose> ground_truth(const Recording& recording) {
  if (!recording.frame_ground_truth.empty()) return recording.frame_ground_truth;
  if (!recording.ground_truth) return {};
  return keyframe_trajectory(recording, *recording.ground_truth);
}

// A value of run.json as a configuration has it. A text, such as the name of a file, is taken as it
// is.
Setting setting_of(const std::string& key, const std::string& text, const DataSetEntry& data_set,
                   const std::string& file) {
  for (const OptionDescription& option : data_set.options) {
    if (key == "dataset." + option.key && option.type == "text") {
      return {key, OptionValue::scalar(text), file};
    }
  }
  Setting setting = parse_override(key + "=" + text);
  setting.origin = file;
  return setting;
}

std::string id_text(const Recording& recording, std::size_t k) {
  const auto& ids = recording.log.ids;
  return std::to_string(ids.empty() ? static_cast<std::int64_t>(k) : ids[k]);
}

// Every registration in order of arrival and the decision on it.
std::string registrations_csv(const Recording& recording, const Result& result) {
  const bool knows_false = !recording.is_false_loop.empty();
  std::string text = "from,to,fate,nis,weight";
  text += knows_false ? ",false\n" : "\n";
  for (std::size_t j = 0; j < result.run.loops.size(); ++j) {
    const LoopDecision& loop = result.run.loops[j];
    text += id_text(recording, loop.from) + ',' + id_text(recording, loop.to) + ',' +
            name_of(loop.fate) + ',';
    text += (loop.nis ? exact(*loop.nis) : "") + ',' + exact(result.run.loop_weights[j]);
    if (knows_false) text += recording.is_false_loop[j] ? ",1" : ",0";
    text += '\n';
  }
  return text;
}

// Every absolute measurement likewise.
std::string absolute_csv(const Recording& recording, const Result& result) {
  std::string text = "keyframe,fate,nis,rank,weight\n";
  std::size_t j = 0;
  for (std::size_t k = 0; k < recording.log.size(); ++k) {
    for (const AbsolutePose& z : recording.log.arrival(k).absolute) {
      const AbsoluteDecision& decision = result.run.absolute[j];
      text += id_text(recording, k) + ',' + name_of(decision.fate) + ',' +
              (decision.nis ? exact(*decision.nis) : "") + ',' +
              std::to_string(rows_of(z.information).rank) + ',' +
              exact(result.run.absolute_weights[j++]) + '\n';
    }
  }
  return text;
}

}  // namespace

std::vector<StampedPose> frame_trajectory(const Recording& recording,
                                          const std::vector<Pose>& keyframes) {
  std::vector<StampedPose> trajectory;
  for (const FramePlace& place : recording.frames) {
    trajectory.push_back(
        {place.time_ns, compose(keyframes[place.keyframe], place.motion_since_keyframe)});
  }
  return trajectory;
}

std::vector<std::string> remarks_of_run(const std::filesystem::path& folder) {
  if (!std::filesystem::exists(folder / "run.json")) return {};
  const auto json = nlohmann::json::parse(read_file(folder / "run.json"), nullptr, false);
  const auto remarks = json.is_object() ? json.find("remarks") : json.end();
  if (!json.is_object() || remarks == json.end() || !remarks->is_array()) return {};
  std::vector<std::string> sentences;
  for (const auto& remark : *remarks) {
    if (remark.is_string()) sentences.push_back(printable(remark.get<std::string>()));
  }
  return sentences;
}

Settings data_settings_of_run(const std::filesystem::path& folder) {
  const std::string file = (folder / "run.json").string();
  if (!std::filesystem::exists(file)) {
    throw InputError(file,
                     "is not there; expected the folder of a run, or of one estimator of a "
                     "comparison");
  }
  const auto json = nlohmann::json::parse(read_file(file), nullptr, false);
  const auto configuration = json.is_object() ? json.find("configuration") : json.end();
  if (!json.is_object() || configuration == json.end() || !configuration->is_object()) {
    throw InputError(file, "has no configuration; expected the run.json of a run");
  }
  // `solve` writes the path of its graph and no data set.
  const auto type = configuration->find("dataset.type");
  const DataSetEntry* data_set = type == configuration->end() || !type->is_string()
                                     ? nullptr
                                     : &find_data_set(type->get<std::string>());
  if (data_set == nullptr || data_set->is_graph) {
    throw InputError(file, "the run was over a pose graph, which has no pictures");
  }
  Settings settings;
  for (const auto& [key, value] : configuration->items()) {
    if (key != "seed" && !key.starts_with("dataset.")) continue;
    if (!value.is_string()) throw InputError(file, key + ": expected a text");
    settings.put(setting_of(key, value.get<std::string>(), *data_set, file));
  }
  return settings;
}

std::vector<StampedPose> keyframe_trajectory(const Recording& recording,
                                             const std::vector<Pose>& poses) {
  std::vector<StampedPose> trajectory;
  for (std::size_t k = 0; k < poses.size(); ++k) {
    trajectory.push_back({recording.keyframe_times_ns[k], poses[k]});
  }
  return trajectory;
}

void write_recording(const std::filesystem::path& folder, const Recording& recording) {
  write_file(folder / "dead_reckoning.tum", to_tum(dead_reckoning(recording)));
  write_graph(folder / "measurements.g2o", recording.log);
  if (has_large_ids(recording.log)) write_file(folder / "ids.csv", ids_csv(recording.log));
  if (!recording.mask.empty()) write_png(folder / "mask.png", recording.mask);
  if (const auto truth = ground_truth(recording); !truth.empty()) {
    write_file(folder / "ground_truth.tum", to_tum(truth));
  }
}

const std::vector<std::string>& optional_run_files() {
  static const std::vector<std::string> names{
      "absolute.csv", "batch_optimum",       "footprints.csv",    "footprints.geojson",
      "frames.tum",   "ground_truth.tum",    "ids.csv",           "loops.geojson",
      "mask.png",     "measurements.shared", "mosaic.json",       "mosaic.pgw",
      "mosaic.png",   "mosaic.tif",          "trajectory.geojson"};
  return names;
}

void write_run(const std::filesystem::path& folder, const Recording& recording,
               const Result& result, const std::string& manifest) {
  const std::vector<Pose>& poses = result.run.trajectory;
  write_recording(folder, recording);
  write_file(folder / "trajectory.tum", to_tum(keyframe_trajectory(recording, poses)));
  write_file(folder / "registrations.csv", registrations_csv(recording, result));
  if (recording.log.absolute_count() > 0) {
    write_file(folder / "absolute.csv", absolute_csv(recording, result));
  }
  write_file(folder / "metrics.json", metrics_json(result, recording));
  write_file(folder / "run.json", manifest);
  if (!recording.frames.empty()) {
    write_file(folder / "frames.tum", to_tum(frame_trajectory(recording, poses)));
  }
}

}  // namespace fathom

#include "fathom/workflow/init.hpp"

#include <map>
#include <memory>
#include <set>

#include "fathom/configuration/config_text.hpp"
#include "fathom/core/files.hpp"
#include "fathom/harness/outlook.hpp"
#include "fathom/harness/survey.hpp"

namespace fathom::workflow {
namespace {

std::string comment_of(const OptionDescription& option) {
  return option.help + (option.unit.empty() ? "" : " (" + option.unit + ")");
}

// Names of files are relative to the working folder: the configuration is to mean the same from
// another one.
std::string as_written(const std::string& key, const std::string& value) {
  static const std::set<std::string> kFiles{"dataset.altitudes", "dataset.mask",
                                            "dataset.odometry"};
  if (value.empty() || !kFiles.contains(key)) return value;
  return std::filesystem::absolute(value).lexically_normal().string();
}

// The data set, and what most users will want to change of the front end.
std::vector<ConfigLine> lines_of(const Configuration& configuration, const Settings& settings) {
  std::map<std::string, std::string> comments;
  const std::map<std::string, std::string> values(configuration.in_force.begin(),
                                                  configuration.in_force.end());
  for (const OptionDescription& option : keys_in_force(values)) {
    comments[option.key] = comment_of(option);
  }
  std::vector<ConfigLine> lines;
  for (const auto& [key, value] : configuration.in_force) {
    const bool is_given = key != "estimator.type" && settings.find(key) != nullptr;
    const bool is_front_end =
        key.starts_with("front_end.") && !key.starts_with("front_end.registration_tuning.");
    if (!is_given && !is_front_end) continue;
    lines.push_back({key, as_written(key, value), value.starts_with('['), comments[key]});
  }
  return lines;
}

std::vector<std::string> assumptions(const FrameSource& frames) {
  std::vector<std::string> assumed;
  const std::string key = "front_end.covariance.";
  if (!frames.has_attitude()) {
    assumed.push_back("loops tell how the camera tilts: if it is known, give " + key +
                      "tilt_sigma_rad what your vehicle has");
  }
  // One that stands in for a reading has a sigma all the same.
  bool is_stated = true;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    is_stated = is_stated && frames.info(i).altitude_sigma_m > 0.0;
  }
  if (!is_stated) {
    assumed.push_back("loops tell how exact altitudes are: if it is known, give " + key +
                      "altitude_sigma_m what your altimeter has");
  }
  assumed.emplace_back(frames.has_odometry()
                           ? "the covariance of odometry is right: candidates go by it"
                           : "there is no odometry: dead reckoning is visual odometry");
  if (!frames.has_ground_truth()) assumed.emplace_back("no ground truth: no error is computed");
  return assumed;
}

std::string header(const std::string& what, const InitOutcome& found) {
  std::string text = "# " + what + " Every value below that was not given is the default.\n";
  for (const std::string& fact : found.facts) text += "#   " + fact + "\n";
  text += "# Assumed:\n";
  for (const std::string& one : found.assumed) text += "#   " + one + "\n";
  return text;
}

std::string estimator_list(const EstimatorRegistry& registry) {
  std::string text = "estimators:  # take away those that you do not want to compare\n";
  for (const EstimatorEntry& entry : registry.entries()) {
    if (entry.runs_program) continue;
    text += "  - {type: " + entry.name + "}\n";
  }
  return text;
}

}  // namespace

InitOutcome init(const InitRequest& request, const EstimatorRegistry& registry) {
  const std::string path = request.survey.string();
  const Configuration configuration =
      configure(request.settings, ConfigurationKind::single, registry);
  const std::unique_ptr<const DataSet> data = open_data_set(configuration);
  if (!std::filesystem::is_directory(path) || data->frames() == nullptr) {
    throw InputError(path,
                     "is no folder of pictures; 'fathom init' writes a configuration for one");
  }
  const FrameSource& frames = *data->frames();
  const Outlook expected = outlook(frames, configuration.front_end);
  InitOutcome outcome;
  outcome.facts = facts_of(expected);
  outcome.assumed = assumptions(frames);
  outcome.warnings = warnings_of(expected, configuration.front_end);
  std::vector<ConfigLine> lines = lines_of(configuration, request.settings);
  StagedFolder folder(request.out, {path});
  write_file(folder.path() / "study.yaml",
             header("Compares back ends over " + path + ".", outcome) + config_text(lines) +
                 estimator_list(registry));
  const std::string type = configuration.estimators.front().type;
  lines.push_back({"estimator.type", type, false, "'fathom list estimators' has the others"});
  write_file(folder.path() / "run.yaml",
             header("Runs one back end over " + path + ".", outcome) + config_text(lines));
  folder.commit();
  outcome.run = folder.target() / "run.yaml";
  outcome.study = folder.target() / "study.yaml";
  return outcome;
}

}  // namespace fathom::workflow

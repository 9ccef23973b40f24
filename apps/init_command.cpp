// fathom init: a configuration and a study for a folder of pictures, every line explained.

#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "fathom/configuration/config_text.hpp"
#include "fathom/core/files.hpp"
#include "fathom/harness/outlook.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/report/table.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom {
namespace {

struct InitFlags {
  CommonFlags common;
  std::string folder;
};

std::string comment_of(const OptionDescription& option) {
  return option.help + (option.unit.empty() ? "" : " (" + option.unit + ")");
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
    lines.push_back({key, value, value.starts_with('['), comments[key]});
  }
  return lines;
}

std::vector<std::string> assumptions(const FrameSource& frames) {
  std::vector<std::string> assumed{
      "the camera tilts by 0.005 rad and altitudes are exact: give "
      "front_end.covariance.tilt_sigma_rad and altitude_sigma_m what your vehicle and sensor have"};
  assumed.emplace_back(frames.has_odometry()
                           ? "the covariance of odometry is right: candidates go by it"
                           : "there is no odometry: dead reckoning is visual odometry");
  if (!frames.has_ground_truth()) assumed.emplace_back("no ground truth: no error is computed");
  return assumed;
}

std::string header(const std::string& what, const std::vector<std::string>& facts,
                   const std::vector<std::string>& assumed) {
  std::string text = "# " + what + " Every value below that was not given is the default.\n";
  for (const std::string& fact : facts) text += "#   " + fact + "\n";
  text += "# Assumed:\n";
  for (const std::string& one : assumed) text += "#   " + one + "\n";
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

void init(const InitFlags& flags, Context& context) {
  const std::string path = std::filesystem::absolute(flags.folder).lexically_normal().string();
  const Settings settings = flags.common.settings(path);
  const EstimatorRegistry& registry = flags.common.estimators();
  const Configuration configuration = configure(settings, ConfigurationKind::single, registry);
  const std::unique_ptr<const DataSet> data = open_data_set(configuration);
  if (!std::filesystem::is_directory(path) || data->frames() == nullptr) {
    throw InputError(path,
                     "is no folder of pictures; 'fathom init' writes a configuration for one");
  }
  const FrameSource& frames = *data->frames();
  const Outlook expected = outlook(frames, configuration.front_end);
  const std::vector<std::string> facts = facts_of(expected);
  const std::vector<std::string> assumed = assumptions(frames);
  std::vector<ConfigLine> lines = lines_of(configuration, settings);
  StagedFolder folder(flags.common.folder_or(workflow::stem_of(path) + "-config"), {path});
  write_file(folder.path() / "study.yaml",
             header("Compares back ends over " + path + ".", facts, assumed) + config_text(lines) +
                 estimator_list(registry));
  const std::string type = configuration.estimators.front().type;
  lines.push_back({"estimator.type", type, false, "'fathom list estimators' has the others"});
  write_file(folder.path() / "run.yaml",
             header("Runs one back end over " + path + ".", facts, assumed) + config_text(lines));
  folder.commit();
  context.status = kDone;
  if (flags.common.quiet) return;
  for (const std::string& fact : facts) std::printf("%s\n", fact.c_str());
  for (const std::string& one : assumed) std::printf("assumed: %s\n", one.c_str());
  for (const std::string& warning : warnings_of(expected, configuration.front_end)) {
    std::printf("warning: %s\n", warning.c_str());
  }
  const std::string run = (folder.target() / "run.yaml").string();
  const std::string study = (folder.target() / "study.yaml").string();
  std::printf(
      "\nwrote %s\n      %s\nrun them with: fathom run %s\n               fathom compare %s\n",
      run.c_str(), study.c_str(), run.c_str(), study.c_str());
}

}  // namespace

void add_init(CLI::App& program, Context& context) {
  auto flags = std::make_shared<InitFlags>();
  Command command(program, "init", "Write a configuration and a study for a folder of pictures",
                  "Example: fathom init my_survey --out my_survey_config\n"
                  "         fathom init photos --set dataset.altitude_m=2.1 "
                  "--set dataset.camera.focal_px=1850\n"
                  "Both have every key of the front end with its value and meaning.");
  command.argument("folder", flags->folder, "Folder in the EuRoC/ASL layout, or of plain pictures");
  flags->common.add_settings_to(command, context);
  flags->common.add_out_to(command, "Output folder (default: runs/FOLDER's name-config)");
  command.on_run([flags, &context] { init(*flags, context); });
}

}  // namespace fathom

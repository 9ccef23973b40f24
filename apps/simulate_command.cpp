// fathom simulate: a simulated survey, written as an image folder.

#include <algorithm>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <system_error>
#include <vector>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "fathom/configuration/config_text.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/start_options.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom {
namespace {

struct SimulateFlags {
  CommonFlags common;
  std::string config;
};

// Whether a key of a simulation has the same meaning for the folder that it makes.
bool is_of_folder(const std::string& key, const std::string& value) {
  static const std::vector<std::string> kKeys{"seed", "evaluation.alignment", "dataset.gap_sigma_m",
                                              "dataset.gap_sigma_rad", "dataset.speed_limit_m_s"};
  static const std::vector<std::string> kIntervals{"dataset.compass.interval_s",
                                                   "dataset.fixes.interval_s"};
  // Off is no sensor: the folder has no readings of it.
  if (std::ranges::find(kIntervals, key) != kIntervals.end()) return value != "off";
  return std::ranges::find(kKeys, key) != kKeys.end() || key.starts_with("front_end.") ||
         key.starts_with("dataset.origin.") || key.starts_with("dataset.start.");
}

// The start as it was drawn.
std::string told_start(const std::string& key, const std::string& given,
                       const StartOptions& start) {
  const std::map<std::string, std::optional<double>> told{
      {"dataset.start.x_m", start.x_m},
      {"dataset.start.y_m", start.y_m},
      {"dataset.start.heading_rad", start.heading_rad}};
  const auto found = told.find(key);
  return found != told.end() && found->second ? exact(*found->second) : given;
}

// A configuration that runs the folder as the simulation would have been: same front end and seed,
// with the keys that were given.
std::string folder_configuration(const Configuration& configuration, const Survey& survey,
                                 const std::string& folder) {
  static const std::string kNoise = "dataset.odometry.";
  std::vector<ConfigLine> lines{{"dataset.type", "image_folder", false, ""},
                                {"dataset.path", folder, false, ""}};
  const auto add = [&lines](const std::string& key, const std::string& value) {
    lines.push_back({key, value, value.starts_with('['), ""});
  };
  for (const auto& [key, value] : configuration.in_force) {
    // Also where it is the default, which is none for a folder.
    const bool is_noise =
        key.starts_with(kNoise + "sigma_") || (key == kNoise + "covariance" && value != "[]");
    if (survey.uses_visual_odometry() && is_noise) {
      add("dataset.added_noise." + key.substr(kNoise.size()), value);
    }
    if (key != "seed" && !configuration.origins.contains(key)) continue;
    if (is_of_folder(key, value)) add(key, told_start(key, value, survey.start()));
    // No row of odometry is left out but over holes.
    if (key == "dataset.holes.count" && value != "0") add("dataset.gap_intervals", "1.5");
  }
  // Of a comparison, the contender that selects the loop candidates, if one does, or the first.
  const CandidateReference& reference = configuration.reference;
  const EstimatorConfiguration& estimator =
      reference.is_contender ? reference.estimator : configuration.estimators.front();
  lines.push_back({"estimator.type", estimator.type, false, ""});
  for (const auto& [key, value] : estimator.values) {
    lines.push_back({"estimator." + key, value.text(), value.is_list, ""});
  }
  return "# The survey in this folder, with the front end it was simulated with.\n" +
         config_text(lines);
}

// What a folder of this layout says of itself: that with it nothing is lost that was measured.
const std::string kSimulatedBody = "comment: simulated by fathom\n";

void refuse_measured_survey(const std::filesystem::path& mav0) {
  std::error_code error;
  if (!std::filesystem::exists(std::filesystem::symlink_status(mav0, error))) return;
  const std::filesystem::path body = mav0 / "body.yaml";
  if (std::filesystem::is_regular_file(body, error) && read_text(body) == kSimulatedBody) return;
  throw InputError(mav0.string(),
                   "is not of 'simulate', which would replace it: name another folder by --out");
}

void simulate(const SimulateFlags& flags, Context& context) {
  const Settings settings = flags.common.settings(flags.config);
  const Configuration configuration =
      configure(without_sweep(settings), kind_of(settings), flags.common.estimators());
  if (!find_data_set(configuration.dataset.type).makes_pictures) {
    throw InputError(flags.config, "dataset.type: 'simulate' takes simulated");
  }
  const std::string out = flags.common.folder_or(workflow::stem_of(flags.config) + "-data");
  // Before the pictures are drawn.
  for (const char* name : {"mav0", "run.yaml"}) {
    refuse_replacing(std::filesystem::path(out) / name,
                     workflow::inputs_of(flags.config, settings));
  }
  refuse_measured_survey(std::filesystem::path(out) / "mav0");
  const Survey survey(configuration);
  StagedFolder folder(out);
  const std::string run = folder_configuration(configuration, survey, folder.target().string());
  // Visual odometry is made again from the pictures: its covariances follow from what a run
  // estimates of them.
  write_image_folder(survey.measured(), folder.path(), survey.readings());
  write_file(folder.path() / "mav0" / "body.yaml", kSimulatedBody);
  write_file(folder.path() / "run.yaml", run);
  folder.commit();
  context.status = kDone;
  if (flags.common.quiet) return;
  print("wrote %zu frames to %s\nrun them with: fathom run %s\n", survey.measured().size(),
        (folder.target() / "mav0").c_str(), (folder.target() / "run.yaml").c_str());
}

}  // namespace

void add_simulate(CLI::App& program, Context& context) {
  auto flags = std::make_shared<SimulateFlags>();
  Command command(program, "simulate", "Write a simulated survey as an image folder",
                  "Example: fathom simulate configs/quickstart.yaml --out survey");
  command.argument("config", flags->config, "Configuration (YAML)");
  flags->common.add_settings_to(command, context);
  flags->common.add_out_to(command, "Output folder (default: runs/CONFIG's name-data)");
  command.on_run([flags, &context] { simulate(*flags, context); });
}

}  // namespace fathom

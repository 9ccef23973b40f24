// fathom simulate: a simulated survey, written as an image folder.

#include <algorithm>
#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "fathom/configuration/config_text.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/core/files.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom {
namespace {

struct SimulateFlags {
  CommonFlags common;
  std::string config;
};

// Whether a key of a simulation has the same meaning for the folder that it makes.
bool is_of_folder(const std::string& key) {
  static const std::vector<std::string> kKeys{"seed",
                                              "evaluation.alignment",
                                              "dataset.compass.interval_s",
                                              "dataset.fixes.interval_s",
                                              "dataset.gap_sigma_m",
                                              "dataset.gap_sigma_rad",
                                              "dataset.speed_limit_m_s"};
  return std::ranges::find(kKeys, key) != kKeys.end() || key.starts_with("front_end.") ||
         key.starts_with("dataset.origin.") || key.starts_with("dataset.start.");
}

// A configuration that runs the folder as the simulation would have been: same front end and seed,
// with the keys that were given.
std::string folder_configuration(const Configuration& configuration, const std::string& folder) {
  std::vector<ConfigLine> lines{{"dataset.type", "image_folder", false, ""},
                                {"dataset.path", folder, false, ""}};
  for (const auto& [key, value] : configuration.in_force) {
    if (key != "seed" && !configuration.origins.contains(key)) continue;
    if (is_of_folder(key)) lines.push_back({key, value, value.starts_with('['), ""});
    // No row of odometry is left out but over holes.
    if (key == "dataset.holes.count" && value != "0") {
      lines.push_back({"dataset.gap_intervals", "1.5", false, ""});
    }
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
  const Survey survey(configuration);
  StagedFolder folder(out);
  const std::string run = folder_configuration(configuration, folder.target().string());
  write_image_folder(survey.frames(), folder.path(), survey.readings());
  write_file(folder.path() / "run.yaml", run);
  folder.commit();
  context.status = kDone;
  if (flags.common.quiet) return;
  print("wrote %zu frames to %s\nrun them with: fathom run %s\n", survey.frames().size(),
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

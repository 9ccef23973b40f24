// fathom check: what is in a file or folder, and what is wrong with it.

#include <algorithm>
#include <filesystem>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/output.hpp"
#include "apps/terminal.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/trajectory_file.hpp"
#include "fathom/measurements/graph_conversion.hpp"
#include "fathom/report/graph_text.hpp"
#include "fathom/report/table.hpp"
#include "fathom/workflow/check.hpp"

namespace fathom {
namespace {

void print_warnings(const std::vector<std::string>& warnings) {
  if (warnings.empty()) print("nothing looks wrong\n");
  for (const std::string& warning : warnings) print("warning: %s\n", warning.c_str());
}

void print_advice(const std::string& advice) {
  if (!advice.empty()) print("%s\n", advice.c_str());
}

void refuse(const std::vector<std::string>& faults) {
  if (faults.empty()) return;
  for (std::size_t i = 0; i < std::min(faults.size(), kMostShown); ++i) {
    print("fault: %s\n", faults[i].c_str());
  }
  if (faults.size() > kMostShown) print("and %zu faults more\n", faults.size() - kMostShown);
  throw InputError(faults.front() + " (" + counted(faults.size(), "fault") + " in all)");
}

void check_graph(const std::string& path, const EstimatorRegistry& registry,
                 const GraphOptions& options) {
  const workflow::GraphCheck found = workflow::check_graph(path, registry, options);
  print("%s", graph_text(found.graph).c_str());
  refuse(found.graph.faults);
  if (found.guess_chi2) print("  F            %.10g at the file's guess\n", *found.guess_chi2);
  print("  F            %.10g at %s\n", found.start_chi2,
        found.starts_from_odometry ? "odometry" : "what a batch solve starts from");
  if (found.batch_chi2) {
    print("  F            %.10g where a batch solve from odometry ends, %s per degree of freedom\n",
          *found.batch_chi2, format_number(found.scale->per_degree_of_freedom, 3).c_str());
  }
  print_advice(found.advice);
  print_warnings(found.warnings);
}

void check_folder(const std::string& path, const CommonFlags& common, const CacheFlags& cache) {
  Terminal terminal(common.quiet);
  const Settings settings = common.settings(path);
  const auto registrations = cache.open(common.quiet);
  const workflow::SurveyCheck found =
      workflow::check_survey(path, settings, common.estimators(), registrations.get(), terminal);
  terminal.clear();
  print("image folder\n");
  for (const std::string& fact : found.folder.facts) print("  %s\n", fact.c_str());
  refuse(found.folder.faults);
  print("what 'fathom run %s' will find\n", path.c_str());
  for (const std::string& fact : found.expected) print("  %s\n", fact.c_str());
  print_advice(found.advice);
  print_warnings(found.folder.warnings);
}

void check_configuration(const std::string& path, const CommonFlags& common,
                         workflow::KnownEstimators& estimators) {
  const PluginFlags& plugins = common.plugins;
  Settings settings = common.given(path);
  load_named_code(settings, plugins, workflow::NamedPlugins::left_out, estimators, true);
  const EstimatorRegistry& registry = estimators.registry();
  const bool is_study = kind_of(settings) == ConfigurationKind::comparison;
  Configuration configuration;
  if (is_study) {
    const Study study = configure_study(settings, registry);
    configuration = study.cells.front();
    const StudyDescription& described = study.description;
    print("study for 'compare': %s, each %s\n", counted(study.cells.size(), "cell").c_str(),
          repeats_text(described.repetition_of(0), described.surveys, described.trials).c_str());
    for (const StudyAxis& axis : study.description.axes) {
      print("  swept %s: %s\n", axis.key.c_str(), counted(axis.labels.size(), "value").c_str());
    }
  } else {
    configuration = configure(settings, ConfigurationKind::single, registry);
    print("configuration for 'run'\n");
  }
  for (const auto& [key, value] : configuration.in_force) {
    print("  %s: %s\n", key.c_str(), value.c_str());
  }
  for (const EstimatorConfiguration& estimator : configuration.estimators) {
    print("  estimator %s: %s\n", estimator.name.c_str(), estimator.type.c_str());
  }
  const std::vector<std::string> named = workflow::named_code(settings).plugins;
  const bool is_whole = plugins.allows_named || named.empty();
  if (!is_whole) {
    print("left out: the plug-ins of the configuration, %s; --allow-plugins loads them\n",
          joined(named, ", ").c_str());
  }
  print("every key is known and every value within its bounds%s\n",
        is_whole ? "" : ", but for those of the plug-ins");
}

void check_trajectory(const std::string& path) {
  const SpatialTrajectory trajectory = read_trajectory({path, {}, {}});
  const auto& poses = trajectory.poses;
  if (poses.empty()) throw InputError(path, "holds no pose");
  double length_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length_m += (poses[i].pose.position_m - poses[i - 1].pose.position_m).norm();
  }
  print("trajectory\n  format       %s\n  poses        %zu\n  path         %s m\n",
        title_of(trajectory.format).c_str(), poses.size(), format_number(length_m, 4).c_str());
}

struct CheckFlags {
  std::string path;
  GraphOptions graph;
  CommonFlags common;
  CacheFlags cache;
};

void check(const CheckFlags& flags, Context& context) {
  const std::string& path = flags.path;
  const std::string ending = std::filesystem::path(path).extension().string();
  context.status = kDone;
  if (flags.common.quiet) print_nothing();
  if (std::filesystem::is_directory(path)) return check_folder(path, flags.common, flags.cache);
  if (ending == ".yaml" || ending == ".yml") {
    return check_configuration(path, flags.common, context.estimators());
  }
  if (!flags.common.overrides.empty()) {
    throw InputError("--set: goes with a configuration or a folder of pictures");
  }
  if (ending == ".bag" || ending == ".db3" || ending == ".mcap") {
    throw InputError(path, "is a bag; fathom import makes a folder of it that can be checked");
  }
  if (ending == ".json" && std::filesystem::exists(path)) {
    throw InputError(path,
                     "is JSON; expected a folder, a configuration (.yaml), a trajectory or a "
                     "pose graph");
  }
  const bool may_be_trajectory = ending == ".tum" || ending == ".txt" || ending == ".csv";
  if (may_be_trajectory && !is_graph(read_text(path))) {
    check_trajectory(path);
  } else {
    check_graph(path, context.estimators().registry(), flags.graph);
  }
}

}  // namespace

void add_check(CLI::App& program, Context& context) {
  auto flags = std::make_shared<CheckFlags>();
  Command command(program, "check", "Say what is in a file or folder and what is wrong with it",
                  "Example: fathom check intel.g2o\n"
                  "A folder is an image folder, .yaml a configuration, .tum, .txt and .csv a "
                  "trajectory\nif it holds none of a graph's lines, else a pose graph.");
  command.argument("path", flags->path, "File or folder");
  add_drop_self_edges_to(command, flags->graph.drop_self_edges);
  flags->common.add_settings_to(command, context);
  flags->cache.add_to(command);
  command.on_run([flags, &context] { check(*flags, context); });
}

}  // namespace fathom

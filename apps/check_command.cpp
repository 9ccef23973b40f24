// fathom check: what is in a file or folder, and what is wrong with it.

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <iterator>
#include <memory>

#include "apps/command.hpp"
#include "apps/common.hpp"
#include "apps/graph_text.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/datasets/folder_summary.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "fathom/datasets/sensor_summary.hpp"
#include "fathom/harness/outlook.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/measurements/connected_guess.hpp"
#include "fathom/measurements/graph_check.hpp"
#include "fathom/report/table.hpp"

namespace fathom {
namespace {

// A batch solve tells how large the residuals of this graph are; it is quick.
std::vector<std::string> check_information(const MeasurementLog& log,
                                           const EstimatorRegistry& registry) {
  std::vector<std::string> warnings;
  const EstimatorEntry& solver = registry.find("ceres_pose_graph");
  ReplayOptions options;
  options.mode = SolveMode::batch;
  options.covariances = false;
  const Replay solved = replay(log, solver, {}, options);
  if (!is_done(solved.outcome)) return warnings;
  const auto scale = information_scale(log, solved.trajectory);
  if (!scale) return warnings;
  std::printf(
      "  F            %.10g where a batch solve from odometry ends, %s per degree of "
      "freedom\n",
      chi2(log, solved.trajectory), format_number(scale->per_degree_of_freedom, 3).c_str());
  if (scale->looks_like_square_roots) {
    warnings.push_back(
        "the information values look like square roots of the right ones: F per degree of freedom "
        "is " +
        format_number(scale->per_degree_of_freedom, 3) + ", with their squares it would be " +
        format_number(scale->squared, 3) + ", and 1 is expected");
  } else if (scale->per_degree_of_freedom < 0.1) {
    warnings.push_back("the information values look too small: F per degree of freedom is " +
                       format_number(scale->per_degree_of_freedom, 3) +
                       ", and 1 is expected; covariances will be too large");
  } else if (scale->per_degree_of_freedom > 10.0) {
    warnings.push_back("F per degree of freedom is " +
                       format_number(scale->per_degree_of_freedom, 3) +
                       ", and 1 is expected: wrong loops, information values that are too large, "
                       "or a start that ends in a wrong minimum");
  }
  return warnings;
}

void print_warnings(const std::vector<std::string>& warnings) {
  if (warnings.empty()) std::printf("nothing looks wrong\n");
  for (const std::string& warning : warnings) std::printf("warning: %s\n", warning.c_str());
}

void refuse(const std::vector<std::string>& faults) {
  if (faults.empty()) return;
  for (std::size_t i = 0; i < std::min(faults.size(), kShown); ++i) {
    std::printf("fault: %s\n", faults[i].c_str());
  }
  if (faults.size() > kShown) std::printf("and %zu faults more\n", faults.size() - kShown);
  throw InputError(faults.front() + " (" + plural(faults.size(), "fault") + " in all)");
}

// What 'run' and 'solve' refuse is refused here: all read the graph by record_graph.
void check_graph(const std::string& path, const EstimatorRegistry& registry) {
  const GraphSummary graph = summarise_graph(path);
  print_graph(graph);
  refuse(graph.faults);
  const MeasurementLog log = record_graph(path).log;
  if (log.guess) std::printf("  F            %.10g at the file's guess\n", chi2(log, *log.guess));
  const bool is_guessed = log.hole_count() > 0 || log.start().is_free;
  std::printf("  F            %.10g at %s\n",
              chi2(log, is_guessed ? connected_guess(log) : log.odometry()),
              is_guessed ? "what a batch solve starts from" : "odometry");
  std::vector<std::string> warnings = check_information(log, registry);
  if (graph.badly_conditioned > 0) {
    warnings.push_back(plural(graph.badly_conditioned, "edge") +
                       " with badly conditioned information (above 1e8)");
  }
  if (graph.loops == 0 && graph.priors.count() == 0) {
    warnings.push_back("no loops: nothing can correct the dead reckoning");
  }
  if (graph.priors.of_nothing > 0) {
    warnings.push_back(plural(graph.priors.of_nothing, "prior") + " without any information");
  }
  print_warnings(warnings);
}

struct OpenedFolder {
  std::unique_ptr<ImageFolder> with_holes;  ///< where odometry stops for five of its intervals
  std::unique_ptr<ImageFolder> plain;       ///< as a run has it by default; null: refused
  const ImageFolder* folder = nullptr;      ///< that of the two to look at
  std::string refusal;
};

// A folder that a run refuses for want of odometry is described all the same.
OpenedFolder open_folder(const std::string& path) {
  OpenedFolder opened;
  OdometryGaps gaps;
  gaps.least_intervals = 5.0;
  opened.with_holes = std::make_unique<ImageFolder>(path, gaps);
  try {
    opened.plain = std::make_unique<ImageFolder>(path);
  } catch (const InputError& error) {
    opened.refusal = error.what();
  }
  opened.folder = opened.plain ? opened.plain.get() : opened.with_holes.get();
  return opened;
}

void check_folder(const std::string& path) {
  if (is_plain_picture_folder(path)) {
    throw InputError(path, "is a folder of plain pictures, which do not say all; 'fathom init " +
                               path +
                               "' says what to expect of them, and asks for what it needs to know");
  }
  const OpenedFolder opened = open_folder(path);
  const ImageFolder& folder = *opened.folder;
  FolderSummary summary = summarise_frames(folder);
  sum_up_sensors(folder.sensors(), summary);
  sum_up_holes(*opened.with_holes, summary);
  if (!opened.refusal.empty()) summary.faults.push_back(opened.refusal);
  std::printf("image folder\n");
  for (const std::string& fact : summary.facts) std::printf("  %s\n", fact.c_str());
  refuse(summary.faults);
  const FrontEndOptions front_end;
  const Outlook expected = outlook(folder, front_end);
  std::printf("what 'fathom run %s' will find\n", path.c_str());
  for (const std::string& fact : facts_of(expected)) std::printf("  %s\n", fact.c_str());
  std::ranges::copy(warnings_of(expected, front_end), std::back_inserter(summary.warnings));
  print_warnings(summary.warnings);
}

void check_configuration(const std::string& path, workflow::KnownEstimators& estimators) {
  Settings settings = read_settings(path);
  estimators.load(settings, {});
  const EstimatorRegistry& registry = estimators.registry();
  const bool is_study = kind_of(settings) == ConfigurationKind::comparison;
  Configuration configuration;
  if (is_study) {
    const Study study = configure_study(settings, registry);
    configuration = study.cells.front();
    const StudyDescription& described = study.description;
    std::printf(
        "study for 'compare': %zu cells, each %s\n", study.cells.size(),
        repeats_text(described.repetition_of(0), described.surveys, described.trials).c_str());
    for (const StudyAxis& axis : study.description.axes) {
      std::printf("  swept %s: %zu values\n", axis.key.c_str(), axis.labels.size());
    }
  } else {
    configuration = configure(settings, ConfigurationKind::single, registry);
    std::printf("configuration for 'run'\n");
  }
  for (const auto& [key, value] : configuration.in_force) {
    std::printf("  %s: %s\n", key.c_str(), value.c_str());
  }
  for (const EstimatorConfiguration& estimator : configuration.estimators) {
    std::printf("  estimator %s: %s\n", estimator.name.c_str(), estimator.type.c_str());
  }
  std::printf("every key is known and every value within its bounds\n");
}

void check_trajectory(const std::string& path) {
  const std::vector<StampedPose> trajectory = read_tum(path);
  if (trajectory.empty()) throw InputError(path, "holds no pose");
  double length_m = 0.0;
  for (std::size_t i = 1; i < trajectory.size(); ++i) {
    length_m += (trajectory[i].pose.position() - trajectory[i - 1].pose.position()).norm();
  }
  std::printf("trajectory\n  poses        %zu\n  path         %s m\n", trajectory.size(),
              format_number(length_m, 4).c_str());
}

void check(const std::string& path, Context& context) {
  const std::string ending = std::filesystem::path(path).extension().string();
  context.status = kDone;
  if (std::filesystem::is_directory(path)) {
    check_folder(path);
  } else if (ending == ".yaml" || ending == ".yml") {
    check_configuration(path, context.estimators());
  } else if (ending == ".tum" || ending == ".txt") {
    check_trajectory(path);
  } else {
    check_graph(path, context.estimators().registry());
  }
}

}  // namespace

void add_check(CLI::App& program, Context& context) {
  auto path = std::make_shared<std::string>();
  Command command(program, "check", "Say what is in a file or folder and what is wrong with it",
                  "Example: fathom check intel.g2o\n"
                  "A folder is an image folder, .yaml a configuration, .tum a trajectory, else a "
                  "pose graph.");
  command.argument("path", *path, "File or folder");
  command.on_run([path, &context] { check(*path, context); });
}

}  // namespace fathom

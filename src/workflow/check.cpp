#include "fathom/workflow/check.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <memory>

#include "fathom/configuration/config_file.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_folder.hpp"
#include "fathom/datasets/sensor_summary.hpp"
#include "fathom/harness/advice.hpp"
#include "fathom/harness/outlook.hpp"
#include "fathom/harness/recording.hpp"
#include "fathom/harness/replay.hpp"
#include "fathom/harness/survey.hpp"
#include "fathom/measurements/connected_guess.hpp"
#include "fathom/measurements/graph_numbers.hpp"
#include "fathom/report/table.hpp"
#include "fathom/workflow/calibrate.hpp"
#include "fathom/workflow/inputs.hpp"

namespace fathom::workflow {
namespace {

// A batch solve tells how large the residuals of this graph are; it is quick.
void check_information(const MeasurementLog& log, const EstimatorRegistry& registry,
                       GraphCheck& checked) {
  ReplayOptions options;
  options.mode = SolveMode::batch;
  options.covariances = false;
  const Run solved = replay(log, registry.find("ceres_pose_graph"), {}, options);
  if (!is_done(solved.outcome)) return;
  checked.scale = information_scale(log, solved.trajectory);
  if (!checked.scale) return;
  checked.batch_chi2 = chi2(log, solved.trajectory);
  const double per_degree = checked.scale->per_degree_of_freedom;
  const std::string is = format_number(per_degree, 3);
  if (checked.scale->looks_like_square_roots) {
    checked.warnings.push_back(
        fmt::format("the information values look like square roots of the right ones: F per degree "
                    "of freedom is {}, with their squares it would be {}, and 1 is expected",
                    is, format_number(checked.scale->squared, 3)));
  } else if (per_degree < 0.1) {
    checked.warnings.push_back(
        "the information values look too small: F per degree of freedom is " + is +
        ", and 1 is expected; covariances will be too large");
  } else if (per_degree > 10.0) {
    checked.warnings.push_back("F per degree of freedom is " + is +
                               ", and 1 is expected: wrong loops, information values that are too "
                               "large, or a start that ends in a wrong minimum");
    if (checked.graph.turned_edges > 0) {
      checked.warnings.push_back(counted(checked.graph.turned_edges, "edge") +
                                 " with a heading beyond 2 pi: headings look like degrees, and "
                                 "radians are expected");
    }
  }
}

struct OpenedFolder {
  std::unique_ptr<ImageFolder> with_holes;  ///< where odometry stops for five of its intervals
  std::unique_ptr<ImageFolder> plain;       ///< as a run has it by default; null: refused
  const ImageFolder* folder = nullptr;      ///< that of the two to look at
  std::string refusal;
};

// A folder that a run refuses for want of odometry is described all the same.
OpenedFolder open_folder(const std::filesystem::path& path) {
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

bool is_off(const Settings& settings, const char* key) {
  const Setting* given = settings.find(key);
  return given != nullptr && word_of(*given, key) == "false";
}

// What a run of fixes needs and the settings do not give. Without an origin the rest is looked at
// without them.
void ask_for_fixes(const FolderSensors& sensors, Settings& settings, FolderSummary& summary) {
  if (!sensors.fixes || is_off(settings, "dataset.fixes.use")) return;
  const bool has_compass = sensors.compass && !is_off(settings, "dataset.compass.use");
  if (!has_compass && settings.find("dataset.start.heading_rad") == nullptr) {
    summary.warnings.emplace_back(
        "fixes without a compass: a run needs dataset.start.heading_rad with its sigma_rad");
  }
  if (sensors.fixes->on_earth.empty()) return;
  if (settings.find("dataset.origin.latitude") != nullptr) return;
  summary.warnings.emplace_back(
      "fixes in latitude and longitude: a run needs dataset.origin (latitude, longitude, heading)");
  settings.put({"dataset.fixes.use", OptionValue::scalar("false"), "check"});
}

void sum_up_folder(const std::filesystem::path& path, Settings& settings, FolderSummary& summary) {
  const OpenedFolder opened = open_folder(path);
  const ImageFolder& folder = *opened.folder;
  summary = summarise_frames(folder);
  sum_up_sensors(folder.sensors(), summary);
  ask_for_fixes(folder.sensors(), settings, summary);
  sum_up_holes(*opened.with_holes, opened.plain.get(), summary);
  std::ranges::copy(folder.remarks(), std::back_inserter(summary.warnings));
  if (!opened.refusal.empty()) summary.faults.push_back(opened.refusal);
}

}  // namespace

// All read the graph by record_graph.
GraphCheck check_graph(const std::filesystem::path& path, const EstimatorRegistry& registry,
                       const GraphOptions& options) {
  GraphCheck checked;
  checked.graph = summarise_graph(path, options);
  const GraphSummary& graph = checked.graph;
  if (!graph.faults.empty()) return checked;
  const MeasurementLog log = record_graph(path, options).log;
  if (log.guess) checked.guess_chi2 = chi2(log, *log.guess);
  checked.starts_from_odometry = log.hole_count() == 0 && !log.start().is_free;
  checked.start_chi2 =
      chi2(log, checked.starts_from_odometry ? log.odometry() : connected_guess(log));
  check_information(log, registry, checked);
  checked.advice = text_of(advise(loop_terms(log)));
  std::ranges::copy(graph_remarks(log), std::back_inserter(checked.warnings));
  if (graph.badly_conditioned > 0) {
    checked.warnings.push_back(counted(graph.badly_conditioned, "edge") +
                               " with badly conditioned information (above 1e8)");
  }
  if (graph.loops == 0 && graph.priors.count() == 0) {
    checked.warnings.emplace_back("no loops: nothing can correct the dead reckoning");
  }
  if (graph.priors.of_nothing > 0) {
    checked.warnings.push_back(counted(graph.priors.of_nothing, "prior") +
                               " without any information");
  }
  return checked;
}

SurveyCheck check_survey(const std::filesystem::path& path, const Settings& given,
                         const EstimatorRegistry& registry, RegistrationCache* registrations,
                         Observer& observer) {
  SurveyCheck checked;
  Settings settings = given;
  const bool is_plain = is_plain_picture_folder(path);
  if (!is_plain) sum_up_folder(path, settings, checked.folder);
  if (!checked.folder.faults.empty()) return checked;
  const Configuration configuration = configure(settings, ConfigurationKind::single, registry);
  const FrontEndOptions& front_end = configuration.front_end;
  const std::unique_ptr<const DataSet> data = open_data_set(configuration);
  if (is_plain) {
    checked.folder = summarise_frames(*data->frames());
    std::ranges::copy(data->remarks(), std::back_inserter(checked.folder.warnings));
    if (!checked.folder.faults.empty()) return checked;
  }
  const Outlook expected = outlook(*data->frames(), front_end);
  checked.expected = facts_of(expected);
  if (const auto advice = advise(expected)) checked.advice = text_of(*advice, "survey");
  const CalibrateOutcome calibrated = calibrate({settings, registrations}, registry, observer);
  std::ranges::copy(facts_of(calibrated.done.calibration), std::back_inserter(checked.expected));
  checked.folder.warnings.insert(checked.folder.warnings.begin(),
                                 calibrated.done.calibration.findings.begin(),
                                 calibrated.done.calibration.findings.end());
  std::ranges::copy(warnings_of(expected, front_end), std::back_inserter(checked.folder.warnings));
  return checked;
}

}  // namespace fathom::workflow

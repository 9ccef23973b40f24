#include "study_options.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/measurements/spoil.hpp"

namespace fathom {
namespace {

// Of an estimator in a cell: more would be no study but a mistake.
constexpr double kMostRuns = 1e6;
constexpr const char* kFalseLoops = "association.false_loops";

std::vector<std::string> described_keys(void (StudyOptions::*describe)(OptionTable&)) {
  StudyOptions options;
  OptionTable table;
  (options.*describe)(table);
  return table.keys();
}

bool is_or_is_below(const std::string& key, const std::string& group) {
  return key == group || key.starts_with(group + ".");
}

void require_each(const Settings& settings, const std::string& key,
                  const std::vector<double>& values, const std::string& expected,
                  bool (*is_right)(double)) {
  if (!std::ranges::all_of(values, is_right)) {
    refuse(*settings.find(key), key + ": expected " + expected);
  }
}

void require_known_metrics(const Settings& settings, const std::vector<std::string>& metrics) {
  for (const std::string& name : metrics) {
    if (find_metric(name)) continue;
    std::vector<std::string> all;
    for (const Metric& metric : metric_catalogue()) all.push_back(metric.name);
    if (std::ranges::find(all, name) != all.end()) {
      refuse(*settings.find("report.metrics"),
             "report.metrics: " + in_quotes(name) +
                 ": expected a number in place of N or D, as in rpe_1_keyframes_m or rpe_5_m_m");
    }
    refuse(*settings.find("report.metrics"),
           fmt::format("report.metrics: unknown metric {}{} ('fathom list metrics' has all)",
                       in_quotes(name), suggestion(name, all)));
  }
}

// Why a data set has one survey, whatever a study asks for.
std::string why_one_survey(const DataSetEntry& data_set, const DataSetOptions& options) {
  switch (data_set.repetition()) {
    case Repetition::surveys:
      break;
    case Repetition::pictures:
      return "an " + data_set.name + " is one set of pictures, of which nothing is drawn again";
    case Repetition::logs:
      return data_set.name + " draws everything in each of its trials";
    case Repetition::graph:
      return "a " + data_set.name + " graph is always the same";
  }
  return options.why_surveys_are_alike();
}

void check_repeats(const Settings& settings, const StudyOptions& study,
                   const DataSetEntry& data_set, const DataSetOptions& options) {
  const std::string one = study.surveys > 1 ? why_one_survey(data_set, options) : "";
  if (!one.empty()) refuse(*settings.find("surveys"), "surveys: " + one + "; expected 1");
  const double runs = static_cast<double>(study.surveys) * static_cast<double>(study.trials);
  if (runs <= kMostRuns) return;
  refuse(
      *settings.find(study.surveys > 1 ? "surveys" : "trials"),
      fmt::format(
          "surveys: {} of {} trials each are too many; expected surveys times trials of at most {}",
          study.surveys, study.trials, static_cast<int>(kMostRuns)));
}

// A share of 0 that is given may be one of several: a sweep begins without false loops and keeps
// the rest.
std::vector<IgnoredKey> ignored_of_false_loops(const Settings& settings,
                                               const SpoilOptions& options) {
  std::vector<IgnoredKey> ignored;
  if (settings.find(std::string(kFalseLoops) + ".share") == nullptr) {
    ignored = {{"kind", "share"}, {"group_size", "share"}, {"reach", "share"}};
  } else {
    if (options.kind != FalseLoopKind::grouped) ignored.push_back({"group_size", "kind"});
    if (options.kind != FalseLoopKind::local) ignored.push_back({"reach", "kind"});
  }
  return below(kFalseLoops, ignored);
}

}  // namespace

void StudyOptions::describe_session(OptionTable& table) {
  table.integer("surveys", surveys, Range::between(1, kMostRuns), "",
                "draws of what a simulated survey has once: floor, attitude, sensors");
  table.integer("trials", trials, Range::between(1, kMostRuns), "",
                "runs of every estimator in every cell and survey, each with noise of its own");
  table.integer("jobs", jobs, Range::between(1, 1024), "",
                "trials at work at the same time; cost is comparable at 1 alone");
  table.text("report.title", title, "title of the report");
  table.words("report.metrics", metrics, "metrics of the tables, in this order");
  table.real("report.margin", margin, Range::between(0.0, 1.0), "",
             "differences from the best up to this share of its mean are none");
}

void StudyOptions::describe(OptionTable& table) {
  describe_session(table);
  table.enumeration<Association>(
      "association.mode", association, {{"shared", Association::shared}, {"own", Association::own}},
      "loop candidates by the reference's estimate, for all, or by each estimator's own");
  table.group(kFalseLoops, false_loops);
  table.reals("evaluation.rpe_keyframes", evaluation.rpe_keyframes, 1, "keyframes",
              "relative errors over so many keyframes");
  table.reals("evaluation.rpe_distances_m", evaluation.rpe_distances_m, 1, "m",
              "relative errors over such distances along the true path");
  table.integer("evaluation.anchors", evaluation.anchors, Range::between(1, 1000), "keyframes",
                "keyframes held in turn (anchored_anees)");
  table.integer("evaluation.relative_pairs", evaluation.relative_pairs, Range::between(1, 1000), "",
                "motions over each separation or distance, and keyframes for each anchor, at most");
  table.real("evaluation.held_out_loops", evaluation.held_out_loops, Range::between(0.0, 0.5), "",
             "share of the loops left out of a second run of every estimator and compared with its "
             "estimate; 0: no second run");
  table.integer("evaluation.held_out_pairs", evaluation.held_out_pairs, Range::between(1, 10000),
                "", "held-out loops that held_out_nis is over, at most");
  table.boolean("evaluation.newest_covariance", newest_covariance,
                "ask for the covariance of the newest pose after every keyframe, and time it");
  table.real("evaluation.min_overlap", evaluation.recalled_overlap, Range::between(0.01, 1.0), "",
             "true overlap from which on a pair of keyframes should be found (loop_recall)");
}

bool is_study_key(const std::string& key) {
  static const std::vector<std::string> described = described_keys(&StudyOptions::describe);
  for (const char* const group : {"sweep", "report", "association"}) {
    if (is_or_is_below(key, group)) return true;
  }
  return std::ranges::find(described, key) != described.end();
}

bool is_session_key(const std::string& key) {
  static const std::vector<std::string> described = described_keys(&StudyOptions::describe_session);
  return std::ranges::find(described, key) != described.end();
}

std::vector<IgnoredKey> ignored_study_keys(const Settings& settings, const StudyOptions& study) {
  std::vector<IgnoredKey> ignored = ignored_of_false_loops(settings, study.false_loops);
  if (study.evaluation.held_out_loops == 0.0) {
    ignored.push_back({"evaluation.held_out_pairs", "evaluation.held_out_loops"});
  }
  return ignored;
}

void add_unused_trials(const Settings& settings, const StudyOptions& study,
                       const DataSetEntry& data_set, std::vector<UnusedSetting>& unused) {
  if (data_set.draws_trials() || study.trials == 1 || study.false_loops.share > 0.0) return;
  unused.push_back({"trials", settings.find("trials")->origin +
                                  ": trials: a pose graph without false loops has nothing to "
                                  "draw; expected 1"});
}

void check_study(const Settings& settings, const StudyOptions& study, const DataSetEntry& data_set,
                 const DataSetOptions& options) {
  check_repeats(settings, study, data_set, options);
  require_known_metrics(settings, study.metrics);
  if (data_set.is_graph && study.association == Association::own) {
    refuse(*settings.find("association.mode"),
           "association.mode: a pose graph has its loops; expected shared");
  }
  require_each(settings, "evaluation.rpe_keyframes", study.evaluation.rpe_keyframes,
               "whole numbers >= 1",
               [](double n) { return n >= 1.0 && n == std::floor(n) && n < 1e9; });
  require_each(settings, "evaluation.rpe_distances_m", study.evaluation.rpe_distances_m,
               "numbers in m > 0", [](double distance_m) { return distance_m > 0.0; });
}

}  // namespace fathom

#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fathom/configuration/config_file.hpp"
#include "fathom/configuration/isolation.hpp"
#include "fathom/datasets/data_set.hpp"
#include "fathom/datasets/earth_origin.hpp"
#include "fathom/estimation/registry.hpp"
#include "fathom/evaluation/metric_options.hpp"
#include "fathom/front_end/options.hpp"
#include "fathom/measurements/spoil.hpp"

namespace fathom {

/// The data set of a run or comparison.
struct DataSetConfiguration {
  std::string type = data_sets().front().name;
  DataSetValues values;  ///< as given; the rest are defaults
};

/// One estimator of a run or comparison.
struct EstimatorConfiguration {
  std::string name;  ///< in tables and folders; its type unless the configuration names it
  std::string type;
  EstimatorValues values;  ///< as given; the rest are defaults
};

/// Whose trajectory selects the loop candidates (data association).
enum class Association {
  shared,  ///< one reference's: every estimator gets the same log, bit for bit
  own      ///< each estimator's own, as in the paper
};

/// The trajectory that selects the loop candidates of a recording.
struct CandidateReference {
  enum class Kind {
    automatic,     ///< ground truth where every keyframe has it, else the estimate of `estimator`
    ground_truth,  ///< of every keyframe
    estimate       ///< of `estimator`, which runs along with the front end
  };
  Kind kind = Kind::automatic;
  EstimatorConfiguration estimator;
  /// Whether that is one of those compared, which then meets a log of its own choice.
  bool is_contender = false;
};

/// An estimator that selects its own candidates, or those of all.
CandidateReference by_contender(const EstimatorConfiguration& estimator);

/// What a comparison has beside a run.
struct StudyOptions {
  std::string title;
  int surveys = 1;
  int trials = 1;
  int jobs = 1;
  Association association = Association::shared;
  SpoilOptions false_loops;  ///< share 0: none
  MetricOptions evaluation;
  bool newest_covariance = true;
  double margin = 0.01;  ///< of equivalence, as a share of the best mean
  std::vector<std::string> metrics{"mean_position_error_m",
                                   "ate_rmse_m",
                                   "heading_rmse_rad",
                                   "anees",
                                   "chi2_gap",
                                   "held_out_position_error_m",
                                   "held_out_nis",
                                   "loop_closures",
                                   "update_ms.median",
                                   "update_ms.p95",
                                   "total_ms",
                                   "total_with_covariance_ms",
                                   "memory_bytes"};

  void describe(OptionTable& table);
  /// Of them those that no result depends on.
  void describe_session(OptionTable& table);
};

/// A whole configuration, checked: every key is known and every value within its bounds.
struct Configuration {
  DataSetConfiguration dataset;
  EarthOriginOptions origin;  ///< where the survey starts; all of it or nothing
  FrontEndOptions front_end;
  /// One for `run`, which selects its loop candidates itself; for `compare` several.
  std::vector<EstimatorConfiguration> estimators;
  CandidateReference reference;
  StudyOptions study;                ///< of a comparison
  std::vector<std::string> plugins;  ///< files; whoever makes the registry loads them
  IsolationOptions isolation;
  int seed = 1;
  /// Every key with its value in force, defaults included, for the manifest. Keys that have no
  /// effect beside the others are left out.
  std::vector<std::pair<std::string, std::string>> in_force;
  /// The type of every key but those of estimators (OptionDescription).
  std::map<std::string, std::string> types;
  /// Where each given key was given, for messages of checks across keys.
  std::map<std::string, std::string> origins;
};

/// `run` takes one estimator (the keys below `estimator`), `compare` a list (`estimators`; without
/// one, every estimator with its defaults); `simulate` and `register` take either, as they need
/// none.
enum class ConfigurationKind { single, comparison };

/// The kind that these settings are written for: a comparison if any key is of the list alone.
ConfigurationKind kind_of(const Settings& settings);

/// Checks settings and turns them into a configuration. Throws InputError with the origin of the
/// setting, the nearest known key or the bound that it breaks.
Configuration configure(const Settings& settings, ConfigurationKind kind,
                        const EstimatorRegistry& registry);

/// A setting that has no effect beside the others, and what a refusal says of it.
struct UnusedSetting {
  std::string key;
  std::string message;
};

/// The same, but settings without effect are told and not refused: of a study another cell may have
/// a use for them.
Configuration configure(const Settings& settings, ConfigurationKind kind,
                        const EstimatorRegistry& registry, std::vector<UnusedSetting>& unused);

/// The keys of a run, but for its estimator's, that have an effect where some have these values.
/// Throws InputError.
std::vector<OptionDescription> keys_in_force(const std::map<std::string, std::string>& values);

/// The estimator's values from settings whose keys are its own, checked against the entry.
/// `prefix` is what stands before them in messages.
EstimatorValues estimator_values(const Settings& settings, const EstimatorEntry& entry,
                                 const EstimatorSetup& setup, const std::string& prefix);

/// Every option of an estimator with the value in force, by key.
std::vector<std::pair<std::string, std::string>> estimator_options(
    const EstimatorConfiguration& estimator, const EstimatorEntry& entry);

}  // namespace fathom

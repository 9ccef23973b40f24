#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/ignored_key.hpp"
#include "fathom/core/options.hpp"
#include "fathom/datasets/absolute_readings.hpp"
#include "fathom/datasets/frame_source.hpp"
#include "fathom/datasets/start_options.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Values by option key, without the `dataset.` of the configuration.
using DataSetValues = std::map<std::string, OptionValue>;

/// The noise streams of one trial: which seed, that of its survey, and which trial.
struct TrialNoise {
  std::uint64_t seed = 0;
  std::uint64_t trial = 0;
};

/// The measurements of one trial of a pose graph, with the true poses of its keyframes.
struct DrawnGraph {
  MeasurementLog log;
  std::vector<StampedPose> ground_truth;
};

/// What one trial makes of a data set.
struct Trial {
  /// The frames as this trial measures them, with the same pictures; none: the data set's own.
  std::unique_ptr<FrameSource> frames = nullptr;
  /// Covariance of the noise that is to be added to each motion, recorded or of visual odometry.
  Eigen::Matrix3d added_noise = Eigen::Matrix3d::Zero();
  /// Whether motions are to be those of visual odometry though there is odometry.
  bool visual_odometry = false;
  /// The measurements that this trial draws; none: pictures, or a graph that is always the same.
  std::optional<DrawnGraph> graph = std::nullopt;
  /// What compass and positioning system measured of the frames.
  AbsoluteReadings absolute = {};
  StartOptions start = {};
};

/// A data set, opened: either pictures or a pose graph. May be used from several threads at once.
class DataSet {
 public:
  virtual ~DataSet() = default;

  /// The pictures; motions may be those of no trial. Null for a pose graph.
  virtual const FrameSource* frames() const { return nullptr; }

  /// The measurements of a pose graph; null for pictures.
  virtual const MeasurementLog* graph() const { return nullptr; }

  /// A trial: `values` are those that it was opened with, but for the options of a trial. What
  /// refers to the frames must not outlive the data set. Throws InputError.
  virtual Trial trial(const DataSetValues& values, const TrialNoise& noise) const;

  /// What its files state and nobody reads, a line each, with file and line.
  virtual std::vector<std::string> remarks() const { return {}; }

  /// The files that it reads: they tell this data set from what stood there at another time.
  virtual std::vector<std::filesystem::path> files() const { return {}; }
};

/// The option struct of a data set, of whatever type: what a configuration sets and checks.
class DataSetOptions {
 public:
  virtual ~DataSetOptions() = default;
  virtual void describe(OptionTable& table) = 0;
  virtual std::vector<IgnoredKey> ignored_keys() const = 0;
  /// Why every survey of these options is the same; empty where surveys differ, or are not drawn.
  virtual std::string why_surveys_are_alike() const = 0;
};

/// What is drawn again where a study repeats a data set.
enum class Repetition {
  surveys,   ///< floor, attitude and sensors once a survey; dead reckoning in each of its trials
  pictures,  ///< recorded: noise that is added, in each trial
  logs,      ///< all measurements, in each trial
  graph      ///< recorded: false loops alone, in each trial
};

/// One kind of data set, a word of `dataset.type`.
struct DataSetEntry {
  std::string name;
  std::string help;             ///< one line
  bool is_graph = false;        ///< a pose graph, without pictures
  bool makes_pictures = false;  ///< rather than reading them: `fathom simulate` writes them out
  std::vector<OptionDescription> options;  ///< keys below `dataset`
  /// Of them those that only say what a trial measures: what is opened does not depend on them.
  std::vector<OptionDescription> trial_options;
  /// Whether `dataset.origin` is among the values that a trial is given.
  bool takes_origin = false;
  /// Whether a trial has anything to draw: noise of pictures, or measurements.
  bool draws_trials() const { return !is_graph || !trial_options.empty(); }
  Repetition repetition() const {
    if (is_graph) return draws_trials() ? Repetition::logs : Repetition::graph;
    return makes_pictures ? Repetition::surveys : Repetition::pictures;
  }
  std::function<std::unique_ptr<DataSetOptions>()> make_options;
  /// What is the same in all trials follows from the seed alone. Throws InputError that names the
  /// whole key.
  std::function<std::unique_ptr<DataSet>(const DataSetValues&, std::uint64_t seed)> open;
};

/// All kinds there are: the one place from which `fathom list`, the configuration checks and the
/// documentation are made. The first is the default.
const std::vector<DataSetEntry>& data_sets();

/// Throws InputError naming the nearest known one.
const DataSetEntry& find_data_set(const std::string& name);

/// An option struct with these values. Throws InputError on an unknown key or a bad value.
template <class Options>
Options options_of(const DataSetValues& values) {
  Options options;
  OptionTable table;
  options.describe(table);
  if constexpr (requires { options.describe_origin(table); }) options.describe_origin(table);
  for (const auto& [key, value] : values) table.set(key, value);
  return options;
}

/// Makes the entry of a data set from its option struct. It has `describe(OptionTable&)` and, where
/// there are such options, `describe_trial(OptionTable&)` for those of a trial and `ignored_keys()`
/// for those that others leave without effect; also `why_surveys_are_alike()`, and
/// `describe_origin(OptionTable&)` where a trial depends on `dataset.origin`, which every data set
/// of pictures has anyway. `open` takes (const Options&, std::uint64_t seed).
template <class Options, class Open>
DataSetEntry make_data_set(std::string name, std::string help, Open open) {
  class Described : public DataSetOptions {
   public:
    void describe(OptionTable& table) override { options_.describe(table); }
    std::vector<IgnoredKey> ignored_keys() const override {
      if constexpr (requires { options_.ignored_keys(); }) return options_.ignored_keys();
      return {};
    }
    std::string why_surveys_are_alike() const override {
      if constexpr (requires { options_.why_surveys_are_alike(); }) {
        return options_.why_surveys_are_alike();
      }
      return {};
    }

   private:
    Options options_;
  };
  DataSetEntry entry;
  entry.name = std::move(name);
  entry.help = std::move(help);
  Options defaults;
  OptionTable all;
  defaults.describe(all);
  entry.options = all.descriptions();
  if constexpr (requires(OptionTable & table) { defaults.describe_trial(table); }) {
    OptionTable of_trial;
    defaults.describe_trial(of_trial);
    entry.trial_options = of_trial.descriptions();
  }
  entry.takes_origin = requires(OptionTable & table) {
    defaults.describe_origin(table);
  };
  entry.make_options = [] { return std::make_unique<Described>(); };
  entry.open = [open](const DataSetValues& values, std::uint64_t seed) -> std::unique_ptr<DataSet> {
    return open(options_of<Options>(values), seed);
  };
  return entry;
}

}  // namespace fathom

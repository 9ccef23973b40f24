#pragma once

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/estimation/estimator.hpp"

namespace fathom {

/// `incremental`: an estimate after every keyframe. `batch`: one solve, in finish().
enum class SolveMode { incremental, batch };

/// What an estimator is told beside its options.
struct EstimatorSetup {
  StartPose start;  ///< where keyframe 0 is
  SolveMode mode = SolveMode::incremental;
};

/// Values by option key, without the `estimator.` of the configuration.
using EstimatorValues = std::map<std::string, OptionValue>;

struct EstimatorEntry {
  std::string name;
  std::string help;  ///< one line
  bool can_batch = false;
  std::vector<OptionDescription> options;
  /// Of them those that every estimator takes, so that one word changes the back end of a run, and
  /// that this one has no use for. In a list of estimators, each with options of its own, they are
  /// refused.
  std::vector<std::string> unused_options;
  /// Throws InputError on an unknown key or a bad value.
  std::function<std::unique_ptr<Estimator>(const EstimatorSetup&, const EstimatorValues&)> create;
  /// The same of the values alone: nothing is made. Absent: `create` has to be asked.
  std::function<void(const EstimatorSetup&, const EstimatorValues&)> check;
  std::filesystem::path plugin{};  ///< the file that brings it; empty: built in
  /// Names and hashes of the content that does its work, where that is not the file `plugin` alone.
  std::vector<std::pair<std::string, std::string>> code{};
  /// Whether a program that its options name does the work. It stands in no list of all estimators,
  /// and by default has a process of its own.
  bool runs_program = false;

  bool is_built_in() const { return plugin.empty(); }
};

/// Name → factory and described options: the one place from which `fathom list`, the configuration
/// checks and the documentation are made.
class EstimatorRegistry {
 public:
  /// Throws InputError where the name is no plain word, or is taken.
  void add(EstimatorEntry entry);
  const std::vector<EstimatorEntry>& entries() const { return entries_; }
  /// Throws InputError naming the nearest known estimator.
  const EstimatorEntry& find(const std::string& name) const;

 private:
  std::vector<EstimatorEntry> entries_;
};

/// Makes the entry of an estimator from its option struct (which has `describe(OptionTable&)` and,
/// where options depend on one another or on the setup, `check(const EstimatorSetup&)` throwing
/// InputError).
template <class Options, class Make>
EstimatorEntry make_entry(std::string name, std::string help, bool can_batch, Make make) {
  EstimatorEntry entry;
  entry.name = std::move(name);
  entry.help = std::move(help);
  entry.can_batch = can_batch;
  Options defaults;
  OptionTable table;
  defaults.describe(table);
  entry.options = table.descriptions();
  const auto options_of = [](const EstimatorSetup& setup, const EstimatorValues& values) {
    Options options;
    // A table takes a few hundredths of a small graph's solve.
    if (!values.empty()) {
      OptionTable bound;
      options.describe(bound);
      for (const auto& [key, value] : values) bound.set(key, value);
    }
    if constexpr (requires { options.check(setup); }) options.check(setup);
    return options;
  };
  entry.create = [make, options_of](const EstimatorSetup& setup, const EstimatorValues& values) {
    return std::unique_ptr<Estimator>(make(setup, options_of(setup, values)));
  };
  entry.check = [options_of](const EstimatorSetup& setup, const EstimatorValues& values) {
    options_of(setup, values);
  };
  return entry;
}

}  // namespace fathom

#pragma once

#include <compare>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

namespace fathom {

/// One axis of a study's sweep: a key and the values that it takes, in order.
struct StudyAxis {
  std::string name;                 ///< for tables; the key unless the study names it
  std::string key;                  ///< of the configuration
  std::vector<std::string> labels;  ///< of the values; the values as written unless labelled
};

struct StudyEstimator {
  std::string name;
  std::string type;
};

/// What a study is, apart from its results. Cells are the product of the axes, the last axis
/// running fastest; without axes there is one cell.
struct StudyDescription {
  std::string title;
  std::string alignment;   ///< of all errors: none, origin or se2
  std::size_t trials = 1;  ///< asked for, per cell
  std::vector<StudyAxis> axes;
  std::vector<StudyEstimator> estimators;
  std::vector<std::string> metrics;  ///< for tables and charts, in this order
  /// Every key that results depend on, with its value; the sweep's too. Neither trials nor jobs.
  std::vector<std::pair<std::string, std::string>> configuration;

  std::size_t cell_count() const;
  /// The place on each axis of a cell.
  std::vector<std::size_t> places_of(std::size_t cell) const;
  /// "separation 5, noise level 2"; "all" without axes.
  std::string label_of(std::size_t cell) const;
  /// How a cell's loop candidates were picked, `shared` or `own`; empty where there are none.
  std::string association_of(std::size_t cell) const;
};

/// The name under which dead reckoning, the baseline, stands among the estimators' runs. It is no
/// estimator of the registry, and none may be called so.
inline constexpr const char* kDeadReckoning = "dead_reckoning";

/// One run: an estimator (or dead reckoning) on a trial of a cell.
struct RunKey {
  std::size_t cell = 0;
  std::size_t trial = 0;
  std::string estimator;

  auto operator<=>(const RunKey&) const = default;
};

/// What is kept of a run. What is not known is absent; nothing in it is NaN.
struct RunRecord {
  RunKey key;
  std::string outcome;                    ///< name_of(Outcome); empty for dead reckoning
  std::string log_hash;                   ///< FNV-1a of the measurement log as g2o
  int jobs = 1;                           ///< runs that were at work at the same time
  std::map<std::string, double> metrics;  ///< docs/formats.md lists them
  std::map<std::string, std::vector<double>> series;  ///< likewise
};

/// Whether a metric depends on the machine (times and memory), so that it differs from run to run.
bool is_cost_metric(const std::string& name);

/// The results of one study: one SQLite file, `results.sqlite` (docs/formats.md has its schema).
/// Throws InputError on a file that is no such store, is of another schema version, cannot be read
/// or cannot be written (a full disk among them); nothing of a run is ever stored in part.
class ResultStore {
 public:
  /// Opens a store to look at, its folder may be read-only. `path`: the file, or its folder.
  static ResultStore open(const std::filesystem::path& path);

  /// Makes the store of a study in a folder, or goes on with what is there: only with the same
  /// configuration, else InputError says what differs. `manifest` (JSON) is that of this session.
  /// One process at a time may write; another one is refused.
  static ResultStore write(const std::filesystem::path& folder, const StudyDescription& study,
                           const std::string& manifest);

  ~ResultStore();
  ResultStore(ResultStore&&) noexcept;

  const StudyDescription& study() const;
  /// The manifests of the sessions that wrote, in order.
  std::vector<std::string> manifests() const;

  /// The keys of all runs there are, in order.
  std::set<RunKey> keys() const;
  /// All runs without their series, in the order of cell, trial and estimator (dead reckoning
  /// first, then as in the study).
  std::vector<RunRecord> runs() const;
  /// A series of one run; nothing where the run has none of that name.
  std::optional<std::vector<double>> series(const RunKey& key, const std::string& name) const;

  /// Stores a run, whole or not at all; one that is there already is left as it is. May be called
  /// from several threads.
  void add(const RunRecord& run);
  /// Ends the writing: leaves one file that opens from a read-only folder.
  void finish();

 private:
  class Database;
  explicit ResultStore(std::unique_ptr<Database> database);

  std::unique_ptr<Database> database_;
};

}  // namespace fathom

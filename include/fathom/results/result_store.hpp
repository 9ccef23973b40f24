#pragma once

#include <compare>
#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fathom/configuration/study_description.hpp"

namespace fathom {

/// One trial of a cell. Trials are numbered within their survey.
struct TrialKey {
  std::size_t survey = 0;
  std::size_t trial = 0;

  // NOLINTNEXTLINE(modernize-use-nullptr): said of what the compiler writes for it
  auto operator<=>(const TrialKey&) const = default;
};

/// "trial 3 of survey 2".
std::string text_of(const TrialKey& trial);

/// One run: an estimator (or dead reckoning) on a trial of a cell's survey.
struct RunKey {
  std::size_t cell = 0;
  std::size_t survey = 0;
  std::size_t trial = 0;
  std::string estimator;

  TrialKey trial_key() const { return {survey, trial}; }
  // NOLINTNEXTLINE(modernize-use-nullptr): said of what the compiler writes for it
  auto operator<=>(const RunKey&) const = default;
};

/// What is kept of a run. What is not known is absent; nothing in it is NaN.
struct RunRecord {
  RunKey key;
  std::string outcome;      ///< name_of(Outcome); empty for dead reckoning
  std::string fault;        ///< how the estimator broke its contract; else empty
  std::string log_hash;     ///< FNV-1a of the measurement log as g2o
  int jobs = 1;             ///< runs that were at work at the same time
  std::size_t session = 0;  ///< place of its manifest in `manifests`; set by the store
  std::string machine;      ///< model of its processor, as that manifest says; set by the store
  std::map<std::string, double> metrics;              ///< docs/studies.md lists them
  std::map<std::string, std::vector<double>> series;  ///< likewise
};

/// The name of a study's results in its folder.
inline constexpr const char* kResultsFile = "results.sqlite";

/// One with figures of a run, and no study's results.
bool is_run_folder(const std::filesystem::path& path);

/// Throws InputError of the folder of a run, which is no study's.
void refuse_run_folder(const std::filesystem::path& path);

/// The results of one study: one SQLite file, `results.sqlite` (docs/outputs.md has its schema).
/// Throws InputError on a file that is no such store, is of another schema version, is damaged,
/// cannot be read or cannot be written (a full disk among them); nothing of a run is ever stored in
/// part. Each run has a checksum over its key, metrics and series, and the study has one: a store
/// that is opened is compared with them as a whole.
class ResultStore {
 public:
  /// Opens a store to look at, its folder may be read-only. `path`: the file, or its folder.
  static ResultStore open(const std::filesystem::path& path);

  /// Makes the store of a study in a folder, or goes on with what is there: only with the same
  /// configuration and data, else InputError says what differs. Title, metrics, names and labels of
  /// the axes become those of `study`; surveys and trials may only grow. `manifest` (JSON) is that
  /// of this session. One process at a time may write; another one is refused.
  static ResultStore write(const std::filesystem::path& folder, const StudyDescription& study,
                           const std::string& manifest);

  ~ResultStore();
  ResultStore(ResultStore&&) noexcept;
  ResultStore& operator=(ResultStore&&) noexcept;

  const StudyDescription& study() const;
  /// The file itself.
  const std::filesystem::path& file() const;
  /// The manifests of the sessions that wrote, in order.
  std::vector<std::string> manifests() const;

  /// All runs without their series, in the order of cell, survey, trial and estimator (dead
  /// reckoning first, then as in the study).
  std::vector<RunRecord> runs() const;
  /// A series of one run; nothing where the run has none of that name.
  std::optional<std::vector<double>> series(const RunKey& key, const std::string& name) const;

  /// A run with its series; nothing where there is none.
  std::optional<RunRecord> run(const RunKey& key) const;

  /// Begins another session: runs that are added from now on are of it.
  void begin_session(const std::string& manifest);
  /// Stores a run, whole or not at all; one that is there already is left as it is. May be called
  /// from several threads.
  void add(const RunRecord& run);
  /// Writes all that is stored now into another file, which must not be there.
  void copy_to(const std::filesystem::path& file) const;
  /// Ends the writing: leaves one file that opens from a read-only folder.
  void finish();

 private:
  class Database;
  explicit ResultStore(std::unique_ptr<Database> database);

  std::unique_ptr<Database> database_;
};

}  // namespace fathom

#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "apps/flags.hpp"
#include "fathom/configuration/configuration.hpp"
#include "fathom/front_end/registration_store.hpp"
#include "fathom/harness/recording.hpp"

namespace fathom {

/// The flags of all commands that read a configuration or run an estimator.
struct CommonFlags {
  std::vector<std::string> overrides;  ///< --set KEY=VALUE
  std::vector<std::string> plugins;    ///< --plugin FILE
  std::optional<int> seed;
  bool quiet = false;
  std::string out;

  void add_settings_to(Command& command);
  void add_out_to(Command& command, const std::string& what);

  /// The file's settings (none for an empty path; of a folder, that it is the data set), then
  /// --set, then --seed. Plug-ins that are named there or by --plugin are loaded.
  Settings settings(const std::string& path) const;
  /// --out, or `runs/` and a name of its own.
  std::string folder_or(const std::string& name) const;
};

/// Of a folder of pictures that is given in place of a configuration: that it is the data set, in
/// the EuRoC/ASL layout or plain.
Settings settings_of_folder(const std::string& path);

/// What a configuration from `path` has the program read: itself, its data set, its floor.
std::vector<std::filesystem::path> inputs_of(const std::string& path, const Settings& settings);

/// The registrations kept in a folder. Where it cannot be used a note says so, unless quiet, and
/// they are kept in memory only.
std::unique_ptr<RegistrationStore> open_registrations(const std::filesystem::path& folder,
                                                      bool quiet);

/// Whether standard error is a terminal.
bool is_error_terminal();

/// The name of a file without folder and ending.
std::string stem_of(const std::string& path);

/// "95 s", "12 min", "13.4 h".
std::string duration_text(double seconds);

/// Of what a front end has tried: "pair 310 of about 1405".
std::string pairs_text(std::size_t pairs, const std::optional<std::size_t>& of_pairs);

/// Progress on the terminal with an estimate of what is left; silent when quiet or when standard
/// error is no terminal.
class ProgressLine {
 public:
  ProgressLine(std::string what, bool quiet);
  ~ProgressLine();
  ProgressLine(const ProgressLine&) = delete;
  ProgressLine& operator=(const ProgressLine&) = delete;

  Progress callback();
  FrontEndProgressCallback front_end_callback();

 private:
  void show(std::size_t done, std::size_t of);
  bool is_due(bool is_last);

  using Clock = std::chrono::steady_clock;
  std::string what_;
  bool shown_ = false;
  bool enabled_;
  /// When so many were done for the first time.
  std::optional<std::pair<Clock::time_point, std::size_t>> first_;
  Clock::time_point last_ = Clock::now();
};

}  // namespace fathom

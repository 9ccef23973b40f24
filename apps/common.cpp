#include "apps/common.hpp"

#include <cstdio>
#include <filesystem>
#include <unistd.h>
#include <utility>

namespace fathom {

void CommonFlags::add_settings_to(Command& command) {
  command.texts("--set", overrides, "KEY=VALUE",
                "Override a setting, for example estimator.type=ekf");
  command.integer("--seed", seed, Range::any(), "N", "Base seed of all noise and of RANSAC");
  command.boolean("--quiet", quiet, "No output but errors");
}

void CommonFlags::add_out_to(Command& command, const std::string& what) {
  command.text("--out", out, "DIR", what);
}

Settings settings_of_folder(const std::string& path) {
  Settings settings;
  settings.put({"dataset.type", OptionValue::scalar("image_folder"), path});
  settings.put({"dataset.path", OptionValue::scalar(path), path});
  return settings;
}

Settings CommonFlags::settings(const std::string& path) const {
  Settings settings;
  if (std::filesystem::is_directory(path)) {
    settings = settings_of_folder(path);
  } else if (!path.empty()) {
    settings = read_settings(path);
  }
  for (const std::string& text : overrides) settings.put(parse_override(text));
  if (seed) settings.put({"seed", OptionValue::scalar(std::to_string(*seed)), "--seed"});
  return settings;
}

std::string CommonFlags::folder_or(const std::string& name) const {
  return out.empty() ? "runs/" + name : out;
}

std::vector<std::filesystem::path> inputs_of(const std::string& path, const Settings& settings) {
  std::vector<std::filesystem::path> inputs{path};
  for (const char* key : {"dataset.path", "dataset.world.picture"}) {
    const Setting* setting = settings.find(key);
    if (setting != nullptr) inputs.emplace_back(word_of(*setting, key));
  }
  return inputs;
}

std::unique_ptr<RegistrationStore> open_registrations(const std::filesystem::path& folder,
                                                      bool quiet) {
  auto store = std::make_unique<RegistrationStore>(folder);
  if (const std::string problem = store->problem(); !problem.empty() && !quiet) {
    std::fprintf(stderr, "fathom: note: no registration cache: %s\n", problem.c_str());
  }
  return store;
}

std::string stem_of(const std::string& path) {
  const std::filesystem::path named(path);
  const std::string stem = (named.has_filename() ? named : named.parent_path()).stem().string();
  return stem.empty() ? "run" : stem;
}

bool is_error_terminal() {
  return ::isatty(STDERR_FILENO) != 0;
}

void say_from_signal(std::string_view text) noexcept {
  // What cannot be said is not said.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

ProgressLine::ProgressLine(std::string what, bool quiet)
    : what_(std::move(what)), enabled_(!quiet && is_error_terminal()) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
}

Progress ProgressLine::callback() {
  if (!enabled_) return {};
  return [this](std::size_t done, std::size_t of) { show(done, of); };
}

void ProgressLine::show(std::size_t done, std::size_t of) {
  const auto now = Clock::now();
  const std::chrono::duration<double> since_last = now - last_;
  if (since_last.count() < 0.2 && done < of) return;
  last_ = now;
  shown_ = true;
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const double left_s =
      done == 0 ? 0.0 : elapsed_s * static_cast<double>(of - done) / static_cast<double>(done);
  std::fprintf(stderr, "\r\033[K%s: %zu of %zu, %.0f s left", what_.c_str(), done, of, left_s);
}

}  // namespace fathom

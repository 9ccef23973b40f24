#include "apps/common.hpp"

#include <cstdio>
#include <filesystem>
#include <unistd.h>
#include <utility>

#include "apps/estimators.hpp"
#include "fathom/datasets/picture_folder.hpp"

namespace fathom {

void CommonFlags::add_settings_to(Command& command) {
  command.texts("--set", overrides, "KEY=VALUE",
                "Override a setting, for example estimator.type=ekf");
  add_plugins_to(command, plugins);
  command.integer("--seed", seed, Range::any(), "N", "Base seed of all noise and of RANSAC");
  command.boolean("--quiet", quiet, "No output but errors");
}

void CommonFlags::add_out_to(Command& command, const std::string& what) {
  command.text("--out", out, "DIR", what);
}

Settings settings_of_folder(const std::string& path) {
  Settings settings;
  const std::string type = is_plain_picture_folder(path) ? "pictures" : "image_folder";
  settings.put({"dataset.type", OptionValue::scalar(type), path});
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
  load_plugins(settings, plugins);
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

ProgressLine::ProgressLine(std::string what, bool quiet)
    : what_(std::move(what)), enabled_(!quiet && is_error_terminal()) {}

ProgressLine::~ProgressLine() {
  if (shown_) std::fprintf(stderr, "\r\033[K");
}

Progress ProgressLine::callback() {
  if (!enabled_) return {};
  return [this](std::size_t done, std::size_t of) { show(done, of); };
}

FrontEndProgressCallback ProgressLine::front_end_callback() {
  if (!enabled_) return {};
  return [this](const FrontEndProgress& at) {
    if (!is_due(at.is_done())) return;
    const std::string left = at.left_s ? ", " + duration_text(*at.left_s) + " left" : "";
    std::fprintf(stderr, "\r\033[K%s: %zu of %zu, %s%s", what_.c_str(), at.pictures, at.of_pictures,
                 pairs_text(at.pairs, at.of_pairs).c_str(), left.c_str());
  };
}

bool ProgressLine::is_due(bool is_last) {
  const auto now = Clock::now();
  if (shown_ && !is_last && now - last_ < std::chrono::milliseconds(200)) return false;
  last_ = now;
  shown_ = true;
  return true;
}

// The first one may have waited for what all need.
void ProgressLine::show(std::size_t done, std::size_t of) {
  if (!first_ && done > 0) first_ = {Clock::now(), done};
  if (!is_due(done == of)) return;
  std::string left;
  if (first_ && done > first_->second) {
    const std::chrono::duration<double> elapsed = last_ - first_->first;
    left = ", " +
           duration_text(elapsed.count() * static_cast<double>(of - done) /
                         static_cast<double>(done - first_->second)) +
           " left";
  }
  std::fprintf(stderr, "\r\033[K%s: %zu of %zu%s", what_.c_str(), done, of, left.c_str());
}

std::string duration_text(double seconds) {
  char text[64];
  // Rounded by less than a tenth.
  if (seconds < 600.0) {
    std::snprintf(text, sizeof text, "%.0f s", seconds);
  } else if (seconds < 36000.0) {
    std::snprintf(text, sizeof text, "%.0f min", seconds / 60.0);
  } else {
    std::snprintf(text, sizeof text, "%.1f h", seconds / 3600.0);
  }
  return text;
}

std::string pairs_text(std::size_t pairs, const std::optional<std::size_t>& of_pairs) {
  const std::string text = "pair " + std::to_string(pairs);
  return of_pairs ? text + " of about " + std::to_string(*of_pairs) : text;
}

}  // namespace fathom

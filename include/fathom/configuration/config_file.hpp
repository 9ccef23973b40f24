#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "fathom/core/options.hpp"

namespace fathom {

/// One setting of a configuration and where it came from.
struct Setting {
  std::string key;  ///< dotted, for example "front_end.ransac.iterations"
  OptionValue value;
  std::string origin;  ///< "FILE:LINE" or "--set KEY=VALUE", for messages
};

/// The settings of a configuration, each key once; later ones replace earlier ones.
class Settings {
 public:
  void put(Setting setting);
  const Setting* find(const std::string& key) const;
  const std::vector<Setting>& all() const { return settings_; }

  /// The settings under `prefix`, the prefix taken off.
  Settings below(const std::string& prefix) const;

 private:
  std::vector<Setting> settings_;
  std::map<std::string, std::size_t, std::less<>> places_;  ///< in settings_, by key
};

/// Reads a YAML file as settings: maps become dotted keys; the items of a list of maps are keyed by
/// their place, `estimators.0.type`. Throws InputError with file and line on what is no YAML, more
/// than one document, a key given twice, a value that is neither scalar nor list, a key of more
/// than 200 bytes, or more than core/yaml_limits.hpp allows.
Settings read_settings(const std::filesystem::path& path);

/// The same of YAML (JSON among it) that is in no file; `source` stands in messages in its place,
/// without a line.
Settings parse_settings(const std::string& yaml, const std::string& source);

/// A `KEY=VALUE` of the command line; the value is YAML, so that lists can be given.
Setting parse_override(const std::string& text);

/// The same, where the value may be a map in braces, `dataset.origin={latitude: 39.5}`: one setting
/// for each of its keys.
std::vector<Setting> parse_overrides(const std::string& text);

/// The single word that a setting gives; a list is refused in the name of `key`, the setting's own
/// key before any prefix was taken off.
const std::string& word_of(const Setting& setting, std::string_view key);

/// Throws InputError at the origin of a setting.
[[noreturn]] void refuse(const Setting& setting, const std::string& message);

}  // namespace fathom

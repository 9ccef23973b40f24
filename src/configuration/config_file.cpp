#include "fathom/configuration/config_file.hpp"

#include <algorithm>
#include <set>
#include <utility>

#include <yaml-cpp/yaml.h>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/yaml_limits.hpp"

namespace fathom {
namespace {

// Where settings come from; of what is no file, a line says nothing.
struct Source {
  std::string name;
  bool is_file = true;
};

std::string at(const Source& source, const YAML::Mark& mark) {
  if (mark.is_null() || !source.is_file) return source.name;
  return source.name + ":" + std::to_string(mark.line + 1);
}

void require_within_limits(const std::string& yaml, const Source& source) {
  if (source.is_file) return require_yaml_within_limits(yaml, source.name);
  if (const auto excess = yaml_excess(yaml)) throw InputError(source.name, excess->what);
}

// Messages show keys whole.
constexpr std::size_t kLongestShown = 200;

void require_short(const std::string& key, const std::string& origin) {
  if (key.size() <= kLongestShown) return;
  throw InputError(origin + ": key " + in_quotes(key) + " has " + std::to_string(key.size()) +
                   " bytes; the limit is " + std::to_string(kLongestShown));
}

// Nested lists are flattened: a list of points is a list of numbers.
void flatten_list(const YAML::Node& list, const std::string& origin, OptionValue& value) {
  for (const YAML::Node& item : list) {
    if (item.IsSequence()) {
      flatten_list(item, origin, value);
    } else if (item.IsScalar()) {
      value.items.push_back(item.Scalar());
    } else {
      throw InputError(origin + ": a list holds scalars or lists");
    }
  }
}

// The values of an axis of a sweep may be lists: each is kept as one item, written as a list.
bool holds_values_of_a_sweep(const std::string& key) {
  return key.starts_with("sweep.") && key.ends_with(".values");
}

bool is_list_of_maps(const YAML::Node& node) {
  return node.IsSequence() && node.size() > 0 && node[0].IsMap();
}

class Flattener {
 public:
  Flattener(Source file, Settings& settings) : file_(std::move(file)), settings_(settings) {}

  void add(const std::string& key, const YAML::Node& node) {
    const std::string origin = at(file_, node.Mark());
    const std::string where = origin + ": " + key + ": ";
    if (node.IsMap()) {
      add_map(key, node);
    } else if (is_list_of_maps(node)) {
      for (std::size_t i = 0; i < node.size(); ++i) {
        if (!node[i].IsMap()) throw InputError(where + "expected a list of maps");
        add_map(key + "." + std::to_string(i), node[i]);
      }
    } else if (node.IsSequence()) {
      OptionValue value;
      value.is_list = true;
      if (holds_values_of_a_sweep(key)) {
        for (const YAML::Node& item : node) add_value_of_a_sweep(item, origin, value);
      } else {
        flatten_list(node, origin, value);
      }
      settings_.put({key, value, origin});
    } else if (node.IsScalar()) {
      settings_.put({key, OptionValue::scalar(node.Scalar()), origin});
    } else {
      throw InputError(where + "has no value");
    }
  }

 private:
  static void add_value_of_a_sweep(const YAML::Node& item, const std::string& origin,
                                   OptionValue& value) {
    OptionValue inner{{}, true};
    if (item.IsSequence()) {
      flatten_list(item, origin, inner);
      value.items.push_back(inner.text());
    } else if (item.IsScalar()) {
      value.items.push_back(item.Scalar());
    } else {
      throw InputError(origin + ": a list holds scalars or lists");
    }
  }

  void add_map(const std::string& prefix, const YAML::Node& map) {
    // Nothing would be put, and nobody would ask whether there is such a key.
    if (map.size() == 0 && !prefix.empty()) {
      throw InputError(at(file_, map.Mark()) + ": " + prefix + ": the map is empty");
    }
    std::set<std::string> seen;
    for (const auto& entry : map) {
      const std::string origin = at(file_, entry.first.Mark());
      if (!entry.first.IsScalar()) throw InputError(origin + ": a key must be a word");
      const std::string key =
          prefix.empty() ? entry.first.Scalar() : prefix + "." + entry.first.Scalar();
      require_short(key, origin);
      // The second time may be written as a dotted key elsewhere in the file.
      if (!seen.insert(key).second || settings_.find(key) != nullptr) {
        throw InputError(origin + ": '" + key + "' is given twice");
      }
      // A null has no mark of its own; the key's is as good.
      if (entry.second.IsNull()) throw InputError(origin + ": " + key + ": has no value");
      add(key, entry.second);
    }
  }

  Source file_;
  Settings& settings_;
};

Settings settings_of(const std::string& content, const Source& source) {
  // It would end the text there, and all that follows would go unread.
  if (content.find('\0') != std::string::npos) {
    throw InputError(source.name, "not YAML: holds a zero byte");
  }
  require_within_limits(content, source);
  Settings settings;
  try {
    const std::vector<YAML::Node> documents = YAML::LoadAll(content);
    if (documents.empty() || documents.front().IsNull()) return settings;
    const YAML::Node& root = documents.front();
    if (documents.size() > 1) {
      throw InputError(at(source, documents[1].Mark()) +
                       ": a second document; expected a single one, without '---' in between");
    }
    if (!root.IsMap())
      throw InputError(at(source, root.Mark()) + ": expected a map of keys and values");
    Flattener(source, settings).add("", root);
  } catch (const YAML::Exception& error) {
    throw InputError(at(source, error.mark) + ": not YAML: " + error.msg);
  }
  return settings;
}

}  // namespace

void Settings::put(Setting setting) {
  const auto [place, is_new] = places_.emplace(setting.key, settings_.size());
  if (is_new) {
    settings_.push_back(std::move(setting));
  } else {
    settings_[place->second] = std::move(setting);
  }
}

const Setting* Settings::find(const std::string& key) const {
  const auto place = places_.find(key);
  return place == places_.end() ? nullptr : &settings_[place->second];
}

Settings Settings::below(const std::string& prefix) const {
  std::vector<std::size_t> places;
  for (auto entry = places_.lower_bound(prefix);
       entry != places_.end() && entry->first.starts_with(prefix); ++entry) {
    places.push_back(entry->second);
  }
  std::sort(places.begin(), places.end());
  Settings part;
  for (const std::size_t place : places) {
    const Setting& setting = settings_[place];
    part.put({setting.key.substr(prefix.size()), setting.value, setting.origin});
  }
  return part;
}

Settings read_settings(const std::filesystem::path& path) {
  return settings_of(read_text(path, kMostYamlBytes), {path.string()});
}

Settings parse_settings(const std::string& yaml, const std::string& source) {
  return settings_of(yaml, {source, false});
}

Setting parse_override(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string origin = "--set " + (text.size() > kLongestShown ? in_quotes(text) : text);
  if (equals == std::string::npos || equals == 0) {
    throw InputError(origin + ": expected KEY=VALUE, for example seed=7");
  }
  const std::string key(trim(text.substr(0, equals)));
  const std::string value(trim(text.substr(equals + 1)));
  require_short(key, origin);
  require_within_limits(value, {origin, false});
  Settings settings;
  try {
    // YAML takes an unquoted word as it is, so that file names and numbers need no quotes.
    const YAML::Node node = YAML::Load(value);
    if (!node.IsScalar() && !node.IsSequence()) return {key, OptionValue::scalar(value), origin};
    Flattener({origin, false}, settings).add(key, node);
  } catch (const YAML::Exception&) {
    return {key, OptionValue::scalar(value), origin};
  }
  if (settings.all().size() != 1 || settings.all().front().key != key) {
    throw InputError(origin + ": expected a value or a list; maps of a list are set one by one, " +
                     "for example estimators.0.type=ekf");
  }
  return {key, settings.all().front().value, origin};
}

std::vector<Setting> parse_overrides(const std::string& text) {
  const std::size_t equals = text.find('=');
  const std::string value(trim(equals == std::string::npos ? "" : text.substr(equals + 1)));
  if (!value.starts_with('{')) return {parse_override(text)};
  Setting map = parse_override(text.substr(0, equals) + "=");
  map.origin += in_quotes(value);
  const Settings settings = parse_settings(value, map.origin);
  std::vector<Setting> all;
  for (const Setting& one : settings.all()) {
    all.push_back({map.key + "." + one.key, one.value, map.origin});
  }
  if (all.empty()) refuse(map, "the map is empty");
  return all;
}

const std::string& word_of(const Setting& setting, std::string_view key) {
  if (setting.value.is_list || setting.value.items.size() != 1) {
    refuse(setting, std::string(key) + ": expected a single word");
  }
  return setting.value.items.front();
}

void refuse(const Setting& setting, const std::string& message) {
  // Not "--trials: trials: …" of a flag that is called as its key.
  const bool has_both = "--" + setting.key == setting.origin && message.starts_with(setting.key);
  throw InputError((has_both ? "--" : setting.origin + ": ") + message);
}

}  // namespace fathom

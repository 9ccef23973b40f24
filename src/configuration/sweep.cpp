#include "sweep.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "fathom/core/text.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "list_items.hpp"
#include "study_options.hpp"

namespace fathom {
namespace {

constexpr const char* kSweep = "sweep.";
constexpr std::size_t kMostAxes = 100;

// A list within the values of an axis was kept as text by the reader.
OptionValue value_of(const std::string& text) {
  if (text.size() < 2 || text.front() != '[' || text.back() != ']') {
    return OptionValue::scalar(text);
  }
  OptionValue list{{}, true};
  const std::string inner = text.substr(1, text.size() - 2);
  for (const std::string_view item : split(inner, ", ")) {
    list.items.emplace_back(item);
  }
  return list;
}

const Setting& required(const Settings& own, std::string_view key, std::string_view prefix) {
  const std::string word(key);
  if (const Setting* setting = own.find(word)) return *setting;
  refuse(own.all().front(),
         fmt::format("{}{} is missing: an axis of a sweep has a key and values", prefix, word));
}

void refuse_unknown(const Settings& own, const std::string& prefix) {
  const std::vector<std::string> known{"key", "name", "values", "labels"};
  for (const Setting& setting : own.all()) {
    if (std::find(known.begin(), known.end(), setting.key) != known.end()) continue;
    refuse(setting, "unknown key '" + prefix + setting.key + "'" + suggestion(setting.key, known));
  }
}

std::vector<std::string> list_of(const Setting& setting, const std::string& key) {
  if (!setting.value.is_list || setting.value.items.empty()) {
    refuse(setting, key + ": expected a list of one value or more");
  }
  return setting.value.items;
}

// Tables and charts show these texts, one beside the other.
void check_text(const std::string& text, const Setting& given, const std::string& what) {
  constexpr std::size_t kLongest = 80;
  if (text.empty()) refuse(given, what + ": a text is empty");
  if (text.size() > kLongest) {
    refuse(given,
           fmt::format(
               "{}: '{}…' has {} characters; a table has room for {}. Give the values short labels",
               what, text.substr(0, 20), text.size(), kLongest));
  }
  const auto is_control = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
  if (std::ranges::any_of(text, is_control)) {
    refuse(given, what + ": a line break or another control character is no text for a table");
  }
}

// `association` is another column, too, but of the same content where the axis is that of its key.
void check_name(const StudyAxis& axis, const Setting& given, const std::string& prefix) {
  const std::string& name = axis.name;
  check_text(name, given, prefix + "name");
  // The other columns of runs.csv and summary.csv.
  const std::vector<std::string> columns{
      "cell",   "association", "survey",  "trial",   "estimator", "outcome", "fault",
      "jobs",   "metric",      "surveys", "n",       "failures",  "mean",    "sd",
      "median", "low_95",      "high_95", "machine", "alignment"};
  const bool is_that_column = name == "association" && axis.key == "association.mode";
  const bool is_column =
      std::ranges::find(columns, name) != columns.end() || find_metric(name).has_value();
  if (is_that_column || !is_column) return;
  refuse(given, prefix + "name: '" + name +
                    "' is another column of the tables; give the axis another name");
}

void check_texts(const Axis& axis, const Setting& given) {
  std::vector<std::string> labels = axis.described.labels;
  for (const std::string& label : labels) check_text(label, given, axis.prefix + "labels");
  std::ranges::sort(labels);
  const auto twice = std::ranges::adjacent_find(labels);
  if (twice == labels.end()) return;
  refuse(given, fmt::format("{}values: '{}' is given twice", axis.prefix, *twice));
}

Axis axis_of(const Settings& own, const std::string& prefix) {
  refuse_unknown(own, prefix);
  Axis axis;
  axis.prefix = prefix;
  const Setting& key = required(own, "key", prefix);
  axis.described.key = word_of(key, prefix + "key");
  if (is_session_key(axis.described.key) || is_sweep_key(axis.described.key)) {
    refuse(key, axis.described.key + " is the study's own and cannot be swept");
  }
  axis.described.name = axis.described.key.substr(axis.described.key.rfind('.') + 1);
  if (const Setting* name = own.find("name")) axis.described.name = word_of(*name, prefix + "name");
  check_name(axis.described, own.find("name") == nullptr ? key : *own.find("name"), prefix);
  const Setting& values = required(own, "values", prefix);
  axis.described.values = list_of(values, prefix + "values");
  axis.described.labels = axis.described.values;
  for (const std::string& text : axis.described.values) {
    axis.values.push_back({axis.described.key, value_of(text), values.origin});
  }
  if (const Setting* labels = own.find("labels")) {
    axis.described.labels = list_of(*labels, prefix + "labels");
    if (axis.described.labels.size() != axis.values.size()) {
      refuse(*labels, fmt::format("{}labels: expected one for each of the {} values", prefix,
                                  axis.values.size()));
    }
  }
  check_texts(axis, own.find("labels") == nullptr ? values : *own.find("labels"));
  return axis;
}

void refuse_gaps(const Settings& settings, std::size_t count) {
  for (const Setting& setting : settings.all()) {
    if (!is_sweep_key(setting.key)) continue;
    if (is_item_below(setting.key, kSweep, count)) continue;
    refuse(setting, setting.key +
                        ": expected a list of axes, such as '- {key: seed, values: "
                        "[1, 2]}', numbered from 0 without a gap");
  }
}

}  // namespace

bool is_sweep_key(const std::string& key) {
  return key == "sweep" || key.starts_with(kSweep);
}

std::vector<Axis> axes_of(const Settings& settings) {
  std::vector<Axis> axes;
  while (true) {
    const std::string prefix = kSweep + std::to_string(axes.size()) + ".";
    const Settings own = settings.below(prefix);
    if (own.all().empty()) break;
    if (axes.size() == kMostAxes) {
      refuse(own.all().front(), fmt::format("sweep: has more than {} axes, the limit", kMostAxes));
    }
    axes.push_back(axis_of(own, prefix));
    const StudyAxis& newest = axes.back().described;
    for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
      const bool is_one_key = axes[i].described.key == newest.key;
      if (!is_one_key && axes[i].described.name != newest.name) continue;
      const char* const same = is_one_key ? "key" : "name";
      refuse(own.all().front(), fmt::format("{0}{1}: two axes have the {1} '{2}'", prefix, same,
                                            is_one_key ? newest.key : newest.name));
    }
    if (const Setting* fixed = settings.find(newest.key)) {
      refuse(*fixed, newest.key + ": is swept, so this value would go unread; change " + prefix +
                         "values instead");
    }
  }
  refuse_gaps(settings, axes.size());
  return axes;
}

}  // namespace fathom

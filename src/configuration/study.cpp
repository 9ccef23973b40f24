#include "fathom/configuration/study.hpp"

#include <algorithm>
#include <cctype>

#include "fathom/core/random.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/version.hpp"
#include "study_options.hpp"

namespace fathom {
namespace {

constexpr const char* kSweep = "sweep.";

bool is_sweep_key(const std::string& key) {
  return key == "sweep" || key.starts_with(kSweep);
}

struct Axis {
  StudyAxis described;
  std::vector<Setting> values;
};

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

const Setting& required(const Settings& own, const std::string& key, const std::string& prefix) {
  if (const Setting* setting = own.find(key)) return *setting;
  refuse(own.all().front(), prefix + key + " is missing: an axis of a sweep has a key and values");
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

Axis axis_of(const Settings& own, const std::string& prefix) {
  refuse_unknown(own, prefix);
  Axis axis;
  const Setting& key = required(own, "key", prefix);
  axis.described.key = word_of(key, prefix + "key");
  if (is_session_key(axis.described.key) || is_sweep_key(axis.described.key)) {
    refuse(key, axis.described.key + " is the study's own and cannot be swept");
  }
  axis.described.name = axis.described.key.substr(axis.described.key.rfind('.') + 1);
  if (const Setting* name = own.find("name")) axis.described.name = word_of(*name, prefix + "name");
  const Setting& values = required(own, "values", prefix);
  axis.described.labels = list_of(values, prefix + "values");
  for (const std::string& text : axis.described.labels) {
    axis.values.push_back({axis.described.key, value_of(text), values.origin});
  }
  if (const Setting* labels = own.find("labels")) {
    axis.described.labels = list_of(*labels, prefix + "labels");
    if (axis.described.labels.size() != axis.values.size()) {
      refuse(*labels, prefix + "labels: expected one for each of the " +
                          std::to_string(axis.values.size()) + " values");
    }
  }
  std::vector<std::string> sorted = axis.described.labels;
  std::sort(sorted.begin(), sorted.end());
  const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
  if (twice != sorted.end()) refuse(values, prefix + "values: '" + *twice + "' is given twice");
  return axis;
}

// A number of an axis is one or two digits here: sweep.0 … sweep.99.
void refuse_gaps(const Settings& settings, std::size_t count) {
  for (const Setting& setting : settings.all()) {
    if (!is_sweep_key(setting.key)) continue;
    bool is_of_an_axis = false;
    for (std::size_t i = 0; i < count; ++i) {
      is_of_an_axis = is_of_an_axis || setting.key.starts_with(kSweep + std::to_string(i) + ".");
    }
    if (!is_of_an_axis) {
      refuse(setting, setting.key +
                          ": expected a list of axes, such as '- {key: seed, values: "
                          "[1, 2]}', numbered from 0 without a gap");
    }
  }
}

std::vector<Axis> axes_of(const Settings& settings) {
  std::vector<Axis> axes;
  while (true) {
    const std::string prefix = kSweep + std::to_string(axes.size()) + ".";
    const Settings own = settings.below(prefix);
    if (own.all().empty()) break;
    axes.push_back(axis_of(own, prefix));
    const StudyAxis& newest = axes.back().described;
    for (std::size_t i = 0; i + 1 < axes.size(); ++i) {
      if (axes[i].described.key == newest.key || axes[i].described.name == newest.name) {
        refuse(own.all().front(), prefix + "key: two axes are '" + newest.name + "'");
      }
    }
    if (const Setting* fixed = settings.find(newest.key)) {
      refuse(*fixed, newest.key + ": is swept, so this value would go unread; change " + prefix +
                         "values instead");
    }
  }
  refuse_gaps(settings, axes.size());
  return axes;
}

// Every key that results depend on, with its value.
std::vector<std::pair<std::string, std::string>> configuration_of(
    const Configuration& base, const std::vector<Axis>& axes, const EstimatorRegistry& registry) {
  std::vector<std::pair<std::string, std::string>> all{{"fathom", version()}};
  const auto is_swept = [&axes](const std::string& key) {
    return std::any_of(axes.begin(), axes.end(),
                       [&key](const Axis& axis) { return axis.described.key == key; });
  };
  const auto put = [&](const std::string& key, const std::string& value) {
    if (!is_session_key(key) && !is_swept(key)) all.emplace_back(key, value);
  };
  for (const auto& [key, value] : base.in_force) put(key, value);
  for (std::size_t e = 0; e < base.estimators.size(); ++e) {
    const EstimatorConfiguration& estimator = base.estimators[e];
    const std::string prefix = "estimators." + std::to_string(e) + ".";
    put(prefix + "name", estimator.name);
    put(prefix + "type", estimator.type);
    for (const auto& [key, value] : estimator_options(estimator, registry.find(estimator.type))) {
      put(prefix + key, value);
    }
  }
  put("association.reference", base.estimators[base.reference].name);
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const std::string prefix = kSweep + std::to_string(a) + ".";
    put(prefix + "key", axes[a].described.key);
    std::string labels;
    std::string values;
    for (std::size_t i = 0; i < axes[a].values.size(); ++i) {
      const OptionValue& value = axes[a].values[i].value;
      std::string text;
      for (const std::string& item : value.items) text += (text.empty() ? "" : ", ") + item;
      values += (i > 0 ? ", " : "") + (value.is_list ? "[" + text + "]" : text);
      labels += (i > 0 ? ", " : "") + axes[a].described.labels[i];
    }
    put(prefix + "values", "[" + values + "]");
    put(prefix + "labels", "[" + labels + "]");
  }
  std::sort(all.begin(), all.end());
  return all;
}

void require_same_names(const Study& study) {
  for (const Configuration& cell : study.cells) {
    bool same = cell.estimators.size() == study.description.estimators.size();
    for (std::size_t e = 0; same && e < cell.estimators.size(); ++e) {
      same = cell.estimators[e].name == study.description.estimators[e].name;
    }
    if (!same) {
      throw InputError("sweep: the estimators' names change from cell to cell; give them a name");
    }
  }
}

}  // namespace

Settings without_sweep(const Settings& settings) {
  Settings rest;
  for (const Setting& setting : settings.all()) {
    if (!is_sweep_key(setting.key)) rest.put(setting);
  }
  return rest;
}

Study configure_study(const Settings& settings, const EstimatorRegistry& registry) {
  const std::vector<Axis> axes = axes_of(settings);
  const Settings base = without_sweep(settings);
  Study study;
  for (const Axis& axis : axes) study.description.axes.push_back(axis.described);
  constexpr std::size_t kMostCells = 10'000;
  if (study.description.cell_count() > kMostCells) {
    throw InputError("sweep: " + std::to_string(study.description.cell_count()) +
                     " cells; a study has at most 10000");
  }
  for (std::size_t cell = 0; cell < study.description.cell_count(); ++cell) {
    Settings own = base;
    std::string values;
    const std::vector<std::size_t> places = study.description.places_of(cell);
    for (std::size_t a = 0; a < axes.size(); ++a) {
      const Setting& value = axes[a].values[places[a]];
      own.put(value);
      values += value.key + "=";
      for (const std::string& item : value.value.items) values += item + ",";
      values += ";";
    }
    study.cells.push_back(configure(own, ConfigurationKind::comparison, registry));
    const auto seed = static_cast<std::uint64_t>(study.cells.back().seed);
    study.noise_seeds.push_back(axes.empty() ? seed : stream_seed(seed, values, 0));
  }
  const Configuration& first = study.cells.front();
  study.description.title = first.study.title;
  study.description.alignment = name_of(first.alignment);
  study.description.trials = static_cast<std::size_t>(first.study.trials);
  for (const EstimatorConfiguration& estimator : first.estimators) {
    study.description.estimators.push_back({estimator.name, estimator.type});
  }
  study.description.metrics = first.study.metrics;
  study.description.configuration = configuration_of(first, axes, registry);
  require_same_names(study);
  return study;
}

}  // namespace fathom

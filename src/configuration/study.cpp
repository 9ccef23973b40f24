#include "fathom/configuration/study.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <map>

#include "canonical_value.hpp"
#include "fathom/core/random.hpp"
#include "fathom/core/version.hpp"
#include "study_options.hpp"
#include "sweep.hpp"

namespace fathom {
namespace {

// A key that no cell has a use for; one that a single cell uses is not in vain.
void refuse_unused_in_all(const std::vector<std::vector<UnusedSetting>>& unused) {
  for (const UnusedSetting& one : unused.front()) {
    const bool everywhere = std::ranges::all_of(unused, [&](const auto& of_cell) {
      return std::ranges::find(of_cell, one.key, &UnusedSetting::key) != of_cell.end();
    });
    if (everywhere) throw InputError(one.message);
  }
}

// The type of a swept option, which all cells share.
std::string type_of(const std::string& key, const Configuration& cell,
                    const EstimatorRegistry& registry) {
  for (std::size_t e = 0; e < cell.estimators.size(); ++e) {
    const std::string prefix = "estimators." + std::to_string(e) + ".";
    if (!key.starts_with(prefix)) continue;
    for (const OptionDescription& option : registry.find(cell.estimators[e].type).options) {
      if (prefix + option.key == key) return option.type;
    }
  }
  const auto found = cell.types.find(key);
  return found == cell.types.end() ? "text" : found->second;
}

// Two spellings of one value would be two cells with draws of their own.
void refuse_same_values(const Axis& axis, const std::string& type) {
  std::map<std::string, std::string> label_of;
  for (std::size_t i = 0; i < axis.values.size(); ++i) {
    const std::string& label = axis.described.labels[i];
    const auto [there, is_new] =
        label_of.emplace(canonical_text(axis.values[i].value, type), label);
    if (is_new) continue;
    refuse(axis.values[i], fmt::format("{}values: '{}' and '{}' are the same value", axis.prefix,
                                       there->second, label));
  }
}

// Keys in force in any cell; those that are not swept are the same in all that have them.
std::map<std::string, std::string> in_force_anywhere(const std::vector<Configuration>& cells) {
  std::map<std::string, std::string> all;
  for (const Configuration& cell : cells) all.insert(cell.in_force.begin(), cell.in_force.end());
  return all;
}

void add_estimators(std::map<std::string, std::string>& all, const Configuration& base,
                    const EstimatorRegistry& registry) {
  for (std::size_t e = 0; e < base.estimators.size(); ++e) {
    const EstimatorConfiguration& estimator = base.estimators[e];
    const std::string prefix = "estimators." + std::to_string(e) + ".";
    all[prefix + "name"] = estimator.name;
    all[prefix + "type"] = estimator.type;
    for (const auto& [key, value] : estimator_options(estimator, registry.find(estimator.type))) {
      all[prefix + key] = value;
    }
  }
}

// Of a study whose candidates all estimators select themselves, or that has none, nothing.
void add_reference(std::map<std::string, std::string>& all, const std::vector<Configuration>& cells,
                   const EstimatorRegistry& registry) {
  const auto shared = std::ranges::find_if(cells, selects_by_reference);
  if (shared == cells.end()) return;
  for (const auto& [key, value] : reference_values(shared->reference, registry)) all[key] = value;
}

std::string values_text(const Axis& axis, const std::string& type) {
  std::string text;
  for (const Setting& value : axis.values) {
    text += (text.empty() ? "" : ", ") + canonical_text(value.value, type);
  }
  return "[" + text + "]";
}

// Every key that results depend on, with its value.
KeyValues configuration_of(const std::vector<Configuration>& cells, const std::vector<Axis>& axes,
                           const EstimatorRegistry& registry) {
  std::map<std::string, std::string> all = in_force_anywhere(cells);
  add_estimators(all, cells.front(), registry);
  add_reference(all, cells, registry);
  std::erase_if(all, [](const auto& entry) { return is_session_key(entry.first); });
  for (const Axis& axis : axes) {
    all.erase(axis.described.key);
    all[axis.prefix + "key"] = axis.described.key;
    all[axis.prefix + "values"] =
        values_text(axis, type_of(axis.described.key, cells.front(), registry));
  }
  all["fathom"] = version();
  return {all.begin(), all.end()};
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

namespace {

// The settings of one cell.
Settings settings_of(const Settings& base, const std::vector<Axis>& axes,
                     const std::vector<std::size_t>& places) {
  Settings own = base;
  for (std::size_t a = 0; a < axes.size(); ++a) own.put(axes[a].values[places[a]]);
  return own;
}

// What names the noise of a cell: its values on the axes.
std::string noise_name(const std::vector<Axis>& axes, const std::vector<std::string>& types,
                       const std::vector<std::size_t>& places) {
  std::string name;
  for (std::size_t a = 0; a < axes.size(); ++a) {
    const Setting& value = axes[a].values[places[a]];
    name += value.key + "=";
    for (const std::string& item : canonical_value(value.value, types[a]).items) name += item + ",";
    name += ";";
  }
  return name;
}

}  // namespace

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
  std::vector<std::vector<UnusedSetting>> unused;
  for (std::size_t cell = 0; cell < study.description.cell_count(); ++cell) {
    const Settings own = settings_of(base, axes, study.description.places_of(cell));
    unused.emplace_back();
    study.cells.push_back(configure(own, ConfigurationKind::comparison, registry, unused.back()));
  }
  refuse_unused_in_all(unused);
  std::vector<std::string> types;
  for (const Axis& axis : axes) {
    types.push_back(type_of(axis.described.key, study.cells.front(), registry));
    refuse_same_values(axis, types.back());
  }
  for (std::size_t cell = 0; cell < study.cells.size(); ++cell) {
    const auto seed = static_cast<std::uint64_t>(study.cells[cell].seed);
    const std::string name = noise_name(axes, types, study.description.places_of(cell));
    study.noise_seeds.push_back(axes.empty() ? seed : stream_seed(seed, name, 0));
  }
  const Configuration& first = study.cells.front();
  study.description.title = first.study.title;
  study.description.alignment = name_of(first.study.evaluation.alignment);
  study.description.surveys = static_cast<std::size_t>(first.study.surveys);
  study.description.trials = static_cast<std::size_t>(first.study.trials);
  for (const EstimatorConfiguration& estimator : first.estimators) {
    study.description.estimators.push_back({estimator.name, estimator.type});
  }
  study.description.metrics = first.study.metrics;
  study.description.margin = first.study.margin;
  study.description.configuration = configuration_of(study.cells, axes, registry);
  require_same_names(study);
  return study;
}

}  // namespace fathom

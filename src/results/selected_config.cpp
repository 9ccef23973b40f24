#include "fathom/results/selected_config.hpp"

#include <algorithm>
#include <cstdio>
#include <fmt/format.h>
#include <set>

#include "fathom/configuration/config_text.hpp"
#include "fathom/configuration/configuration.hpp"
#include "fathom/configuration/isolation.hpp"
#include "fathom/core/text.hpp"
#include "fathom/core/version.hpp"

namespace fathom {
namespace {

bool is_list_text(const std::string& text) {
  return text.size() >= 2 && text.front() == '[' && text.back() == ']';
}

// The values that a study was made with, by key.
class StudyValues {
 public:
  StudyValues(const StudyDescription& study, const Selection& selection)
      : study_(study), values_(study.configuration.begin(), study.configuration.end()) {
    for (std::size_t a = 0; a < study.axes.size(); ++a) add_axis(a, selection);
  }

  /// The value of a swept key, with a comment; nothing where it was not swept.
  const ConfigLine* swept(const std::string& key) const {
    const auto found = swept_.find(key);
    return found == swept_.end() ? nullptr : &found->second;
  }
  const std::string* fixed(const std::string& key) const {
    const auto found = values_.find(key);
    return found == values_.end() ? nullptr : &found->second;
  }
  /// As above, swept or not.
  std::string word(const std::string& key, const std::string& otherwise) const {
    const auto axis = raw_swept_.find(key);
    if (axis != raw_swept_.end()) return axis->second;
    const std::string* value = fixed(key);
    return value == nullptr ? otherwise : *value;
  }
  /// Of every key, swept or not.
  std::map<std::string, std::string> words() const {
    std::map<std::string, std::string> words = raw_swept_;
    words.insert(values_.begin(), values_.end());
    return words;
  }

 private:
  void add_axis(std::size_t a, const Selection& selection) {
    const StudyAxis& axis = study_.axes[a];
    std::set<std::size_t> places;
    for (const std::size_t cell : selection.cells) places.insert(study_.places_of(cell)[a]);
    std::vector<std::string> labels;
    labels.reserve(places.size());
    for (const std::size_t place : places) labels.push_back(axis.labels[place]);
    const std::string& value = axis.written_values()[*places.begin()];
    raw_swept_[axis.key] = value;
    swept_[axis.key] = {axis.key, value, is_list_text(value),
                        places.size() > 1 ? "the first of those looked at: " + joined(labels, ", ")
                                          : "swept in the study"};
  }

  const StudyDescription& study_;
  std::map<std::string, std::string> values_;
  std::map<std::string, ConfigLine> swept_;
  std::map<std::string, std::string> raw_swept_;
};

// Keys of a configuration without its estimator. What is not among them is a comparison's.
std::vector<ConfigLine> common_lines(const StudyValues& values, bool is_built_in) {
  std::vector<ConfigLine> lines;
  for (const OptionDescription& option : keys_in_force(values.words())) {
    const std::string& key = option.key;
    // They were there for others.
    if (is_built_in && (key == "plugins" || is_isolation_key(key))) continue;
    if (const ConfigLine* swept = values.swept(key)) {
      lines.push_back(*swept);
      continue;
    }
    const std::string* value = values.fixed(key);
    if (value == nullptr || (*value == option.default_value && key != "dataset.type")) continue;
    lines.push_back({key, *value, option.type.starts_with("list"), ""});
  }
  return lines;
}

const OptionDescription* find_option(const EstimatorEntry& entry, const std::string& key) {
  const auto found =
      std::find_if(entry.options.begin(), entry.options.end(),
                   [&](const OptionDescription& option) { return option.key == key; });
  return found == entry.options.end() ? nullptr : &*found;
}

std::vector<ConfigLine> estimator_lines(const StudyDescription& study, std::size_t chosen,
                                        const StudyValues& values,
                                        const EstimatorRegistry& registry) {
  const std::string prefix = "estimators." + std::to_string(chosen) + ".";
  const std::string& described = study.estimators[chosen].type;
  const EstimatorEntry& entry = registry.find(values.word(prefix + "type", described));
  // Where the type is swept, the study's values in force are those of its first type.
  const EstimatorEntry& described_entry = registry.find(described);
  const ConfigLine* swept_type = values.swept(prefix + "type");
  std::vector<ConfigLine> lines{
      {"estimator.type", entry.name, false, swept_type == nullptr ? "" : swept_type->comment}};
  for (const OptionDescription& option : entry.options) {
    const std::string key = "estimator." + option.key;
    if (const ConfigLine* swept = values.swept(prefix + option.key)) {
      lines.push_back({key, swept->value, swept->is_list, swept->comment});
      continue;
    }
    const std::string* value = values.fixed(prefix + option.key);
    const OptionDescription* there = find_option(described_entry, option.key);
    if (value == nullptr || there == nullptr || *value == there->default_value) continue;
    lines.push_back({key, *value, is_list_text(option.default_value), ""});
  }
  return lines;
}

// As the shipped configurations have it: the data set first, what is rarely changed last.
void sort_as_written(std::vector<ConfigLine>& lines) {
  const std::vector<std::string> order{"dataset", "front_end", "estimator", "seed", "evaluation"};
  const auto place = [&order](const ConfigLine& line) {
    return std::find(order.begin(), order.end(), line.key.substr(0, line.key.find('.')));
  };
  std::stable_sort(lines.begin(), lines.end(),
                   [&](const ConfigLine& a, const ConfigLine& b) { return place(a) < place(b); });
}

std::string short_number(double value) {
  char buffer[32];
  std::snprintf(buffer, sizeof buffer, "%.4g", value);
  return buffer;
}

std::string comment_line(std::string text) {
  for (char& letter : text) {
    if (static_cast<unsigned char>(letter) < 0x20) letter = ' ';
  }
  return "# " + text + "\n";
}

// How it was chosen, in three lines.
std::string header(const StudyDescription& study, const Selection& selection,
                   const SelectionQuery& query) {
  const EstimatorEvidence& chosen = selection.estimators[*selection.chosen];
  std::string text = comment_line(fmt::format(
      "{}, chosen by 'fathom select' from {}: cells {}{}; each {}", chosen.name,
      study.title.empty() ? "a study" : "the study '" + study.title + "'", selection.cells.size(),
      query.where.empty() ? "" : " (" + joined(query.where, ", ") + ")", selection.repeats));
  std::vector<std::string> requirements;
  for (const Requirement& requirement : query.requirements) {
    requirements.push_back(requirement.text());
  }
  if (!requirements.empty()) {
    text += comment_line("It meets " + joined(requirements, " and ") + " in every cell;");
  }
  const TrialMean& objective = *chosen.objective;
  text += comment_line(std::string(query.maximise ? "greatest " : "least ") + query.objective +
                       ": " + short_number(objective.mean) +
                       (objective.interval
                            ? " [" + short_number(objective.interval->low) + ", " +
                                  short_number(objective.interval->high) + "], 95 % of the mean"
                            : ", of one trial in a cell: no evidence"));
  for (const auto& [key, value] : study.configuration) {
    if (key != "fathom" || value == version()) continue;
    text += comment_line("The study was made by fathom " + value + ", this file by " + version());
  }
  return text;
}

}  // namespace

std::string selected_configuration(const StudyDescription& study, const Selection& selection,
                                   const SelectionQuery& query, const EstimatorRegistry& registry) {
  if (!selection.chosen)
    throw InputError("no estimator was chosen that a configuration could have");
  const StudyValues values(study, selection);
  std::vector<ConfigLine> lines =
      common_lines(values, registry.find(study.estimators[*selection.chosen].type).is_built_in());
  for (ConfigLine& line : estimator_lines(study, *selection.chosen, values, registry)) {
    lines.push_back(std::move(line));
  }
  sort_as_written(lines);
  return header(study, selection, query) + config_text(lines);
}

}  // namespace fathom

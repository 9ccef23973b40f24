#include "fathom/configuration/study_description.hpp"

#include <algorithm>
#include <optional>

#include "fathom/configuration/axis_words.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/data_set.hpp"

namespace fathom {
namespace {

// As the configuration has it, whatever its label is.
std::optional<std::string> swept_value(const StudyDescription& study, std::size_t cell,
                                       const std::string& key) {
  for (std::size_t i = 0; i < study.axes.size(); ++i) {
    if (study.axes[i].key == key) return study.axes[i].written_values()[study.places_of(cell)[i]];
  }
  return std::nullopt;
}

std::string value_of(const StudyDescription& study, std::size_t cell, const std::string& key) {
  if (const auto swept = swept_value(study, cell, key)) return *swept;
  const auto found = std::find_if(study.configuration.begin(), study.configuration.end(),
                                  [&key](const auto& entry) { return entry.first == key; });
  return found == study.configuration.end() ? "" : found->second;
}

// False of a type that this version does not know.
bool is_graph(const std::string& data_set) {
  return std::ranges::any_of(data_sets(), [&](const DataSetEntry& entry) {
    return entry.name == data_set && entry.is_graph;
  });
}

}  // namespace

std::size_t StudyDescription::cell_count() const {
  std::size_t count = 1;
  for (const StudyAxis& axis : axes) count *= axis.labels.size();
  return count;
}

std::vector<std::size_t> StudyDescription::places_of(std::size_t cell) const {
  std::vector<std::size_t> places(axes.size());
  for (std::size_t i = axes.size(); i-- > 0;) {
    places[i] = cell % axes[i].labels.size();
    cell /= axes[i].labels.size();
  }
  return places;
}

std::string StudyDescription::label_of(std::size_t cell) const {
  if (axes.empty()) return "all";
  const std::vector<std::size_t> places = places_of(cell);
  std::string label;
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (i > 0) label += ", ";
    label += text_of(axes[i], places[i]);
  }
  return label;
}

std::string StudyDescription::association_of(std::size_t cell) const {
  return value_of(*this, cell, "association.mode");
}

LoopSelector StudyDescription::selector_of(std::size_t cell) const {
  using Kind = LoopSelector::Kind;
  if (association_of(cell) != "shared" || is_graph(value_of(*this, cell, "dataset.type"))) {
    return {};
  }
  const std::string type = value_of(*this, cell, "association.reference.type");
  if (!type.empty()) return {Kind::outsider, type};
  const std::string name = value_of(*this, cell, "association.reference");
  if (name.empty()) return {};
  if (name == kGroundTruth) return {Kind::ground_truth, ""};
  if (name == kAutomatic) return {Kind::automatic, ""};
  return {Kind::contender, name};
}

std::string StudyDescription::selected_by(std::size_t cell) const {
  const LoopSelector selector = selector_of(cell);
  switch (selector.kind) {
    case LoopSelector::Kind::ground_truth:
      return "ground truth";
    case LoopSelector::Kind::automatic:
      return "ground truth, where there is no such by an estimate";
    case LoopSelector::Kind::outsider:
      return "the estimate of " + selector.estimator + ", no contender";
    case LoopSelector::Kind::contender:
      return "the estimate of " + selector.estimator + ", a contender";
    case LoopSelector::Kind::unknown:
      break;
  }
  return "";
}

bool StudyDescription::considers_shared_errors(std::size_t cell,
                                               const std::string& estimator) const {
  const auto found = std::ranges::find(estimators, estimator, &StudyEstimator::name);
  if (found == estimators.end()) return false;
  const std::string prefix = "estimators." + std::to_string(found - estimators.begin()) + ".";
  return value_of(*this, cell, prefix + "shared_errors") == "consider";
}

std::string StudyDescription::alignment_of(std::size_t cell) const {
  return swept_value(*this, cell, "evaluation.alignment").value_or(alignment);
}

Repetition StudyDescription::repetition_of(std::size_t cell) const {
  const std::string type = value_of(*this, cell, "dataset.type");
  for (const DataSetEntry& entry : data_sets()) {
    if (entry.name == type) return entry.repetition();
  }
  return Repetition::surveys;
}

std::string repeats_text(Repetition repetition, std::size_t surveys, std::size_t trials) {
  const std::string all = counted(trials, "trial");
  switch (repetition) {
    case Repetition::surveys:
      return counted(surveys, "survey") + " × " + all;
    case Repetition::pictures:
      return "one set of pictures, " + all;
    case Repetition::logs:
      break;
    case Repetition::graph:
      return "one graph, " + all;
  }
  return all;
}

std::string limits_of_one_survey(Repetition repetition) {
  switch (repetition) {
    case Repetition::surveys:
      return "one survey: intervals over its trials say nothing of other floors, attitudes and "
             "sensor noise";
    case Repetition::pictures:
      return "one set of pictures: intervals over its trials say nothing of other pictures";
    case Repetition::logs:
      break;
    case Repetition::graph:
      return "one graph: intervals over its trials say nothing of other graphs";
  }
  return "";
}

std::size_t independent_draws(Repetition repetition, std::size_t surveys, std::size_t trials) {
  return repetition == Repetition::logs ? trials : std::min(surveys, trials);
}

}  // namespace fathom

#include "fathom/configuration/study_description.hpp"

#include <algorithm>
#include <optional>

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
    label += axes[i].name + " " + axes[i].labels[places[i]];
  }
  return label;
}

std::string StudyDescription::association_of(std::size_t cell) const {
  const std::string key = "association.mode";
  if (const auto swept = swept_value(*this, cell, key)) return *swept;
  const auto found = std::find_if(configuration.begin(), configuration.end(),
                                  [&key](const auto& entry) { return entry.first == key; });
  return found == configuration.end() ? "" : found->second;
}

std::string StudyDescription::alignment_of(std::size_t cell) const {
  return swept_value(*this, cell, "evaluation.alignment").value_or(alignment);
}

}  // namespace fathom

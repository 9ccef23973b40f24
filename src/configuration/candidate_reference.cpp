#include <algorithm>
#include <fmt/format.h>
#include <string>
#include <vector>

#include "estimator_list.hpp"
#include "fathom/configuration/study.hpp"
#include "fathom/core/text.hpp"

namespace fathom {
namespace {

constexpr const char* kKey = "association.reference";
constexpr const char* kPrefix = "association.reference.";
/// Gives an estimate near the optimum after every keyframe, at little cost.
constexpr const char* kDefaultType = "incremental_smoother";

// A registry of a program that links the library may have other estimators alone.
CandidateReference automatic_reference(const EstimatorRegistry& registry) {
  const auto& entries = registry.entries();
  const bool is_there =
      std::ranges::find(entries, kDefaultType, &EstimatorEntry::name) != entries.end();
  const std::string type = is_there ? kDefaultType : entries.front().name;
  return {CandidateReference::Kind::automatic, {type, type, {}}, false};
}

CandidateReference of_map(const Settings& own, const EstimatorRegistry& registry) {
  if (own.find("type") == nullptr) {
    refuse(own.all().front(), std::string(kPrefix) +
                                  "type is missing: expected ground_truth, the name of an "
                                  "estimator, or a map such as {type: incremental_smoother}");
  }
  if (const Setting* name = own.find("name")) {
    refuse(*name, std::string(kPrefix) + "name: a reference stands in no table and has no name");
  }
  return {CandidateReference::Kind::estimate, configure_estimator(own, registry, kPrefix), false};
}

}  // namespace

bool is_reference_key(const std::string& key) {
  return key == kKey || key.starts_with(kPrefix);
}

CandidateReference by_contender(const EstimatorConfiguration& estimator) {
  return {CandidateReference::Kind::estimate, estimator, true};
}

CandidateReference configure_reference(const Settings& settings,
                                       const std::vector<EstimatorConfiguration>& estimators,
                                       const EstimatorRegistry& registry) {
  const Setting* word = settings.find(kKey);
  const Settings own = settings.below(kPrefix);
  if (word != nullptr && !own.all().empty()) {
    refuse(*word, fmt::format("{}: is given as a map, too, by {}; expected one of them", kKey,
                              own.all().front().origin));
  }
  if (!own.all().empty()) return of_map(own, registry);
  CandidateReference reference = automatic_reference(registry);
  if (word == nullptr) return reference;
  const std::string& name = word_of(*word, kKey);
  if (name == kAutomatic) return reference;
  if (name == kGroundTruth) {
    reference.kind = CandidateReference::Kind::ground_truth;
    return reference;
  }
  const auto found = std::ranges::find(estimators, name, &EstimatorConfiguration::name);
  if (found != estimators.end()) return by_contender(*found);
  std::vector<std::string> names{kGroundTruth, kAutomatic};
  for (const EstimatorConfiguration& estimator : estimators) names.push_back(estimator.name);
  std::string right = suggestion(name, names);
  if (right.empty()) right = "; expected " + joined(names, ", ") + ", or a map with a type";
  refuse(*word, fmt::format("{}: no estimator is called '{}'{}", kKey, name, right));
}

void add_unused_references(const Settings& settings, const Configuration& configuration,
                           std::vector<UnusedSetting>& unused) {
  if (selects_by_reference(configuration)) return;
  const bool is_own = configuration.study.association == Association::own;
  for (const Setting& setting : settings.all()) {
    if (!is_reference_key(setting.key)) continue;
    const std::string why =
        is_own ? "nobody's estimate but each one's own picks the loop candidates; "
                 "use association.mode: shared"
               : "a " + configuration.dataset.type + " graph has its loops; nothing selects them";
    unused.push_back({setting.key, fmt::format("{}: {}: {}", setting.origin, setting.key, why)});
  }
}

KeyValues reference_values(const CandidateReference& reference, const EstimatorRegistry& registry) {
  switch (reference.kind) {
    case CandidateReference::Kind::automatic:
      return {{kKey, kAutomatic}};
    case CandidateReference::Kind::ground_truth:
      return {{kKey, kGroundTruth}};
    case CandidateReference::Kind::estimate:
      break;
  }
  if (reference.is_contender) return {{kKey, reference.estimator.name}};
  KeyValues values{{std::string(kPrefix) + "type", reference.estimator.type}};
  const EstimatorEntry& entry = registry.find(reference.estimator.type);
  for (const auto& [key, value] : estimator_options(reference.estimator, entry)) {
    values.emplace_back(kPrefix + key, value);
  }
  return values;
}

void settle_references(Study& study, CandidateReference::Kind kind,
                       const EstimatorRegistry& registry) {
  for (Configuration& cell : study.cells) {
    if (cell.reference.kind != CandidateReference::Kind::automatic) continue;
    cell.reference.kind = kind;
    KeyValues& stored = study.description.configuration;
    const auto automatic =
        std::ranges::find(stored, std::pair<std::string, std::string>(kKey, kAutomatic));
    if (automatic == stored.end()) continue;
    stored.erase(automatic);
    std::ranges::copy(reference_values(cell.reference, registry), std::back_inserter(stored));
    std::ranges::sort(stored);
  }
}

}  // namespace fathom

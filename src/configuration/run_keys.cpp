#include "run_keys.hpp"

#include <algorithm>
#include <fmt/format.h>

#include "fathom/configuration/study.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

bool is_any_isolated(const Configuration& configuration, const EstimatorRegistry& registry) {
  return std::ranges::any_of(configuration.estimators, [&](const EstimatorConfiguration& one) {
    return configuration.isolation.is_isolated(registry.find(one.type));
  });
}

}  // namespace

void bind_runs(Configuration& configuration, OptionTable& table) {
  table.words("plugins", configuration.plugins, "shared objects with further estimators");
  configuration.isolation.describe(table);
}

bool is_run_key_without_effect(const std::string& key, const Configuration& configuration,
                               const EstimatorRegistry& registry) {
  if (key == "plugins") return configuration.plugins.empty();
  return is_isolation_key(key) && !is_any_isolated(configuration, registry);
}

void add_unused_limits(const Settings& settings, const Configuration& configuration,
                       const EstimatorRegistry& registry, std::vector<UnusedSetting>& unused) {
  if (is_any_isolated(configuration, registry)) return;
  for (const char* const key : {"time_limit_s", "memory_limit_mib"}) {
    const Setting* const setting = settings.find(key);
    if (setting == nullptr) continue;
    unused.push_back({key, fmt::format("{}: {}: no estimator runs in a process of its own, and it "
                                       "would be ignored; isolation: process gives each one",
                                       setting->origin, key)});
  }
}

void check_selection_isolated(const Settings& settings, const Configuration& configuration,
                              const EstimatorRegistry& registry) {
  const bool is_own = configuration.study.association == Association::own;
  const auto refuse_isolated = [&](const std::string& type, const char* key) {
    if (!configuration.isolation.is_isolated(registry.find(type))) return;
    throw InputError(settings.find(key) == nullptr ? "" : settings.find(key)->origin,
                     fmt::format("{}: {} would run beside the front end, which a process of its "
                                 "own cannot; expected isolation: none, or another that selects",
                                 key, type));
  };
  if (is_own) {
    for (const EstimatorConfiguration& one : configuration.estimators) {
      refuse_isolated(one.type, "association.mode");
    }
  } else if (configuration.reference.kind == CandidateReference::Kind::estimate &&
             selects_by_reference(configuration)) {
    refuse_isolated(configuration.reference.estimator.type, "association.reference");
  }
}

}  // namespace fathom

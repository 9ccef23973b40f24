// Plug-ins that must be refused, each for what REFUSED_FOR says; without it, one that exports
// nothing.

#include <memory>
#include <stdexcept>

#include "fathom/estimation/plugin.hpp"

namespace {

[[maybe_unused]] void taken_name(fathom::EstimatorRegistry& registry) {
  fathom::EstimatorEntry entry;
  entry.name = "ekf";
  entry.create = [](const fathom::EstimatorSetup&, const fathom::EstimatorValues&) {
    return std::unique_ptr<fathom::Estimator>();
  };
  registry.add(entry);
}

[[maybe_unused]] void throwing(fathom::EstimatorRegistry&) {
  throw std::runtime_error("no licence");
}

[[maybe_unused]] constexpr auto other_version = nullptr;
[[maybe_unused]] constexpr auto other_build = nullptr;

}  // namespace

#ifdef REFUSED_FOR
#define FATHOM_TEXT_OF(word) #word
#define FATHOM_TEXT(word) FATHOM_TEXT_OF(word)

extern "C" __attribute__((visibility("default"))) const fathom::PluginInterface* fathom_plugin() {
  static const fathom::PluginInterface interface = [] {
    fathom::PluginInterface made;
    const std::string why = FATHOM_TEXT(REFUSED_FOR);
    if (why == "other_version") made.version = 999;
    if (why == "other_build") made.build.eigen_alignment = 1024;
    made.add_estimators = REFUSED_FOR;
    return made;
  }();
  return &interface;
}
#endif

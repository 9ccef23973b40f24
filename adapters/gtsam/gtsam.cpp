// A plug-in with GTSAM's solvers.

#include "adapters/gtsam/entries.hpp"
#include "fathom/estimation/plugin.hpp"

namespace {

void add_estimators(fathom::EstimatorRegistry& registry) {
  registry.add(fathom::gtsam_entry());
  registry.add(fathom::gtsam_isam2_entry());
}

}  // namespace

FATHOM_PLUGIN(add_estimators)

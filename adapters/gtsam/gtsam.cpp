// A plug-in with GTSAM's solvers.

#include <gtsam/config.h>
#ifdef GTSAM_USE_TBB
#include <tbb/global_control.h>
#endif

#include "adapters/gtsam/entries.hpp"
#include "fathom/estimation/plugin.hpp"

namespace {

void add_estimators(fathom::EstimatorRegistry& registry) {
#ifdef GTSAM_USE_TBB
  // Cost is that of one thread.
  static const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
#endif
  registry.add(fathom::gtsam_entry());
  registry.add(fathom::gtsam_isam2_entry());
}

}  // namespace

FATHOM_PLUGIN(add_estimators)

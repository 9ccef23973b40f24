// A Smoother's map where dead reckoning has a hole.

#include "estimators/incremental_smoother/smoother.hpp"
#include "estimators/support/pose_graph/bridge.hpp"

namespace fathom::incremental_smoother {

// All that follows moves, which happens once a hole: the tree is made anew.
void Smoother::bridge(const Bridge& bridge) {
  tree_.settle();
  pose_graph::bridge(bridge, problem_.edges, problem_.nodes);
  evaluate_all();
  rebuild();
  moved_in_ = ++revision_;
}

}  // namespace fathom::incremental_smoother

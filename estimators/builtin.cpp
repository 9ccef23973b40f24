#include "fathom/estimators/builtin.hpp"

#include "estimators/ceres_pose_graph/ceres_pose_graph.hpp"
#include "estimators/ekf/ekf.hpp"
#include "estimators/incremental_smoother/incremental_smoother.hpp"
#include "estimators/sparse_gauss_newton/sparse_gauss_newton.hpp"
#include "estimators/trajectory_iekf/trajectory_iekf.hpp"

namespace fathom {

// An explicit call each: a linker drops the static objects of a static library.
const EstimatorRegistry& builtin_estimators() {
  static const EstimatorRegistry registry = [] {
    EstimatorRegistry all;
    all.add(trajectory_iekf_entry());
    all.add(ekf_entry());
    all.add(ceres_pose_graph_entry());
    all.add(sparse_gauss_newton_entry());
    all.add(incremental_smoother_entry());
    return all;
  }();
  return registry;
}

}  // namespace fathom

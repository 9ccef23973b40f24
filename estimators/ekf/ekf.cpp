#include "estimators/ekf/ekf.hpp"

namespace fathom {

EstimatorEntry ekf_entry() {
  return filter::delayed_state_entry<Ekf>(
      "ekf", "plain EKF on absolute keyframe poses (delayed state), one linearisation");
}

}  // namespace fathom

#include "estimators/first_estimates_ekf/first_estimates_ekf.hpp"

namespace fathom {

FirstEstimatesEkf::FirstEstimatesEkf(const EstimatorSetup& setup,
                                     const filter::DelayedStateOptions& options)
    : DelayedStateFilter(setup, options), first_{setup.start.pose} {}

void FirstEstimatesEkf::note_moved(std::size_t k, const Pose& motion) {
  first_[k] = compose(motion, first_[k]);
}

EstimatorEntry first_estimates_ekf_entry() {
  return filter::delayed_state_entry<FirstEstimatesEkf>(
      "first_estimates_ekf", "delayed-state EKF with Jacobians at the first estimate of each pose");
}

}  // namespace fathom

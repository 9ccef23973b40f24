#pragma once

#include <vector>

#include "estimators/support/filter/delayed_state.hpp"

namespace fathom {

/// The delayed-state EKF with first-estimates Jacobians (Huang, Mourikis and Roumeliotis, *Analysis
/// and Improvement of the Consistency of Extended Kalman Filter based SLAM*, ICRA 2008): every
/// Jacobian with respect to a pose is taken at the first estimate of that pose. All of them have
/// the null space of the true system then, a motion of the whole map.
/// docs/estimators/first_estimates_ekf.md.
class FirstEstimatesEkf final : public filter::DelayedStateFilter {
 public:
  FirstEstimatesEkf(const EstimatorSetup& setup, const filter::DelayedStateOptions& options);

 protected:
  Pose linearised_at(std::size_t k) const override { return first_[k]; }
  void note_added() override { first_.push_back(pose(first_.size())); }
  /// What moves as one keeps its shape: so do its first estimates.
  void note_moved(std::size_t k, const Pose& motion) override;

 private:
  std::vector<Pose> first_;
};

EstimatorEntry first_estimates_ekf_entry();

}  // namespace fathom

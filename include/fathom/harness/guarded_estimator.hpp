#pragma once

#include <memory>
#include <string>
#include <vector>

#include "fathom/estimation/registry.hpp"

namespace fathom {

/// A decorator that checks an estimator against its contract. A fault is a call that throws, a size
/// or a report that does not fit what was given, a pose that is not finite, a matrix that can be no
/// covariance (not finite, not symmetric, a negative variance), a negative NIS, or a weight outside
/// [0, 1]. After the first fault nothing is passed on: updates report `numerical_failure`, poses
/// are NaN. Memory that runs out is no fault of an estimator: std::bad_alloc passes.
class GuardedEstimator : public Estimator {
 public:
  /// Makes an estimator. Throws InputError on an unknown key or a bad value.
  GuardedEstimator(const EstimatorEntry& entry, const EstimatorSetup& setup,
                   const EstimatorValues& values);

  /// The first fault, one line, with the call and the keyframe; empty: none so far.
  const std::string& fault() const { return fault_; }
  /// Of a fault: numerical_failure, or crashed where a program that does the work ended.
  Outcome fault_outcome() const { return fault_outcome_; }

  /// Keyframes given, whatever the estimator says.
  std::size_t size() const override { return size_; }
  Pose pose(std::size_t k) const override;
  /// Names keyframes that there are.
  MovedPoses moved_since(std::uint64_t revision) const override;
  std::optional<std::vector<UncertainPose>> motions_to_newest() const override;
  void add_keyframe(const RelativePose& step) override;
  /// Has one decision for each measurement, in their order.
  UpdateReport update(const Measurements& measurements) override;
  UpdateReport finish(std::span<const Pose> start) override;
  std::optional<Eigen::Matrix3d> covariance(std::size_t k) const override;
  std::optional<Eigen::Matrix3d> newest_covariance() const override;
  std::optional<Eigen::MatrixXd> joint_covariance(
      std::span<const std::size_t> keyframes) const override;
  double loss(double chi2, int rank) const override;
  bool estimates_shared_errors() const override;
  /// Empty, or one for each registration given.
  std::vector<double> loop_weights() const override;
  /// Likewise for each absolute measurement.
  std::vector<double> absolute_weights() const override;

 private:
  template <class Call>
  void guarded(const char* what, Call call) const;
  void check_size(const char* call) const;
  template <class Ask>
  std::vector<double> weights(const char* what, std::size_t count, Ask ask) const;

  std::unique_ptr<Estimator> estimator_;
  std::size_t size_ = 1;
  std::size_t registrations_ = 0;
  std::size_t absolute_ = 0;
  mutable std::string fault_;
  mutable Outcome fault_outcome_ = Outcome::numerical_failure;
};

}  // namespace fathom

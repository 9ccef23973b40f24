#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <Eigen/Core>

#include "fathom/core/options.hpp"
#include "fathom/estimation/estimator.hpp"

namespace fathom {

/// The χ² gate of a registration on its normalised innovation, 3 degrees of freedom.
struct GateOptions {
  /// Share of right registrations that passes, or off.
  std::optional<double> probability;

  void describe(OptionTable& table);
};

class Gate {
 public:
  explicit Gate(const GateOptions& options);

  bool is_on() const { return threshold_.has_value(); }
  /// NaN never passes.
  bool passes(double nis) const;

 private:
  std::optional<double> threshold_;
};

/// Whether every registration's NIS, where there is one, is a number.
bool has_finite_nis(const UpdateReport& report);

/// What the gate's answer makes of a registration.
LoopFate fate_of(bool passes);

/// Marks an update that failed: what its gate let through is lost.
void lose_all(UpdateReport& report, Outcome outcome);

/// S for each of some registrations that are written forward and end at the newest keyframe: the
/// covariance of ν = z − h(x); nothing where they cannot be computed.
using InnovationCovariances = std::function<std::optional<std::vector<Eigen::Matrix3d>>(
    std::span<const RelativePose> forward)>;

/// Decides on every registration of an update, in report.loops; S is asked for only where the gate
/// is on. False where they cannot be judged: a number is not finite, or there is no S.
bool judge(const Gate& gate, const TrajectoryView& estimate,
           std::span<const RelativePose> registrations, const InnovationCovariances& covariances,
           UpdateReport& report);

/// νᵀ S⁻¹ ν; NaN where S is not positive definite.
double normalised_innovation_squared(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& S);

}  // namespace fathom

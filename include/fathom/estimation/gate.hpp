#pragma once

#include <optional>

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

/// νᵀ S⁻¹ ν; NaN where S is not positive definite.
double normalised_innovation_squared(const Eigen::Vector3d& innovation, const Eigen::Matrix3d& S);

}  // namespace fathom

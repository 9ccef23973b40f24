#pragma once

#include <string>
#include <vector>

#include "tests/estimators/spoilt_estimator.hpp"

namespace fathom::test {

/// A good estimator spoilt in one thing, and the clause of the contract that it then breaks.
struct Breach {
  std::string clause;
  std::string how;  ///< a part of what is said
  Spoils spoils;
};

std::vector<Breach> estimate_breaches();
std::vector<Breach> failure_breaches();
std::vector<Breach> loop_breaches();
std::vector<Breach> covariance_breaches();
std::vector<Breach> absolute_breaches();

inline void ignore_the_gate(EstimatorSetup& /*setup*/, EstimatorValues& values) {
  values.erase("gate_probability");
}

// Another number every time.
inline void drift(Pose& pose) {
  static double noise = 0.0;
  pose.x += noise += 1e-15;
}

template <class Matrix>
std::function<void(std::optional<Matrix>&)> times(double factor) {
  return [factor](std::optional<Matrix>& covariance) { *covariance *= factor; };
}

}  // namespace fathom::test

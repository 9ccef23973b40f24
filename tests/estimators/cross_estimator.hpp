#pragma once

#include "tests/estimators/logs.hpp"

namespace fathom::test {

/// Options with which an estimator stops at its optimum and not before.
inline EstimatorValues exactly() {
  return values({{"tolerance", "1e-13"}, {"max_iterations", "100"}});
}

inline EstimatorValues exactly_with(const std::string& loss) {
  EstimatorValues values = exactly();
  values["loss"] = OptionValue::scalar(loss);
  return values;
}

/// A log of which all loops come with the last keyframe: a single update.
inline MeasurementLog loops_at_the_end(double noise) {
  LogOptions options;
  options.loops_at_end_only = true;
  options.noise = noise;
  return circle_log(options);
}

}  // namespace fathom::test

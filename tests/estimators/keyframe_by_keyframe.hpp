#pragma once

#include <cstddef>
#include <memory>
#include <string>

#include "fathom/estimation/registry.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/measurements/measurement_log.hpp"
#include "tests/estimators/logs.hpp"

/// Estimators by name that are given a log one keyframe at a time.
namespace fathom::test {

inline std::unique_ptr<Estimator> make(const std::string& name, const StartPose& start,
                                       const EstimatorValues& values = {},
                                       SolveMode mode = SolveMode::incremental) {
  return builtin_estimators().find(name).create({start, mode}, values);
}

/// Keyframe k of the log and its loops.
template <class AnyEstimator>
UpdateReport arrive(AnyEstimator& estimator, const MeasurementLog& log, std::size_t k) {
  estimator.add_keyframe(log.arrival(k).step);
  return give(estimator, log.arrival(k));
}

}  // namespace fathom::test

#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "fathom/estimation/relative_estimator.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/geometry/covariance.hpp"
#include "src/harness/conformance/logs.hpp"

namespace fathom::test {

// The logs of the conformance suite serve other tests, too.
using namespace conformance;

inline EstimatorValues values(const std::vector<std::pair<std::string, std::string>>& settings) {
  EstimatorValues result;
  for (const auto& [key, value] : settings) result[key] = OptionValue::scalar(value);
  return result;
}

/// What is measured of a keyframe.
inline UpdateReport give(Estimator& estimator, const KeyframeMeasurements& arrival) {
  return estimator.update({arrival.registrations, arrival.absolute});
}
inline UpdateReport give(RelativeEstimator& estimator, const KeyframeMeasurements& arrival) {
  return estimator.close_loops(arrival.registrations);
}

/// Gives a whole log to an estimator; the worst outcome.
template <class AnyEstimator>
Outcome feed(AnyEstimator& estimator, const MeasurementLog& log,
             std::vector<LoopDecision>* decisions = nullptr) {
  Outcome outcome = Outcome::converged;
  for (std::size_t k = 0; k < log.size(); ++k) {
    if (k > 0) estimator.add_keyframe(log.arrival(k).step);
    if (log.arrival(k).registrations.empty() && log.arrival(k).absolute.empty()) continue;
    const UpdateReport report = give(estimator, log.arrival(k));
    outcome = worse(outcome, report.outcome);
    if (decisions != nullptr) {
      decisions->insert(decisions->end(), report.loops.begin(), report.loops.end());
    }
  }
  return worse(outcome, estimator.finish().outcome);
}

inline std::unique_ptr<Estimator> solved(const std::string& type, const MeasurementLog& log,
                                         const EstimatorValues& options = {}) {
  auto estimator = builtin_estimators().find(type).create({log.start()}, options);
  feed(*estimator, log);
  return estimator;
}

}  // namespace fathom::test

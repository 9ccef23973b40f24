#include "subject.hpp"

#include <algorithm>
#include <memory>
#include <sstream>
#include <utility>

#include "expectations.hpp"
#include "fathom/measurements/connected_guess.hpp"

namespace fathom::conformance {
namespace {

// A factory of somebody else's may give nothing, which no one could call.
EstimatorEntry with_checked_factory(EstimatorEntry entry) {
  entry.create = [create = std::move(entry.create)](const EstimatorSetup& setup,
                                                    const EstimatorValues& values) {
    std::unique_ptr<Estimator> made = create(setup, values);
    if (!made) throw std::runtime_error("the factory returned no estimator");
    return made;
  };
  return entry;
}

Outcome give(Estimator& estimator, const MeasurementLog& log,
             std::vector<LoopDecision>* decisions) {
  Outcome outcome = Outcome::converged;
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0) estimator.add_keyframe(arrival.step);
    if (arrival.registrations.empty() && arrival.absolute.empty()) continue;
    const UpdateReport report = estimator.update({arrival.registrations, arrival.absolute});
    outcome = worse(outcome, report.outcome);
    if (decisions != nullptr) {
      decisions->insert(decisions->end(), report.loops.begin(), report.loops.end());
    }
  }
  return outcome;
}

}  // namespace

Subject::Subject(const EstimatorEntry& entry) : entry_(with_checked_factory(entry)) {}

GuardedEstimator& Subject::make(const StartPose& start, const EstimatorValues& values,
                                SolveMode mode) {
  return made_.emplace_back(entry_, EstimatorSetup{start, mode}, values);
}

GuardedEstimator& Subject::solved(const MeasurementLog& log, const EstimatorValues& values) {
  GuardedEstimator& estimator = make(log.start(), values);
  feed(estimator, log);
  return estimator;
}

GuardedEstimator& Subject::solved_in_batch(const MeasurementLog& log,
                                           const EstimatorValues& values) {
  GuardedEstimator& estimator = make(log.start(), values, SolveMode::batch);
  give(estimator, log, nullptr);
  const Outcome outcome = estimator.finish(connected_guess(log)).outcome;
  expect_done("finish", outcome);
  return estimator;
}

bool Subject::has(const std::string& option) const {
  return std::any_of(entry_.options.begin(), entry_.options.end(),
                     [&](const OptionDescription& known) { return known.key == option; });
}

void Subject::need(const std::string& option) const {
  if (!has(option)) throw NotApplicable("no option '" + option + "'");
}

void Subject::need_batch() const {
  if (!can_batch()) throw NotApplicable("no batch mode");
}

EstimatorValues Subject::to_the_optimum(const std::string& tolerance) const {
  EstimatorValues values;
  if (has("tolerance")) values["tolerance"] = OptionValue::scalar(tolerance);
  if (has("max_iterations")) values["max_iterations"] = OptionValue::scalar("100");
  return values;
}

std::vector<std::string> Subject::losses() const {
  std::vector<std::string> all;
  for (const OptionDescription& option : entry_.options) {
    if (option.key != "loss") continue;
    std::istringstream choices(option.range);
    for (std::string word; choices >> word;) {
      if (word != "|" && word != "none") all.push_back(word);
    }
  }
  return all;
}

std::string Subject::fault() const {
  for (const GuardedEstimator& estimator : made_) {
    if (!estimator.fault().empty()) return estimator.fault();
  }
  return "";
}

EstimatorValues value(const std::string& key, const std::string& text) {
  return {{key, OptionValue::scalar(text)}};
}

Outcome feed(Estimator& estimator, const MeasurementLog& log,
             std::vector<LoopDecision>* decisions) {
  const Outcome outcome = give(estimator, log, decisions);
  return worse(outcome, estimator.finish({}).outcome);
}

}  // namespace fathom::conformance

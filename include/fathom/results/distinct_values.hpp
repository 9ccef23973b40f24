#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <tuple>

#include "fathom/evaluation/clustered.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// A metric of runs by survey, each draw once: what repeats of one measurement log say alike is one
/// result, however often it is repeated. Runs without the hash of a log are apart, and of a cost
/// every repeat is a measurement.
class DistinctValues {
 public:
  explicit DistinctValues(const std::string& metric) : is_cost_(is_cost_metric(metric)) {}

  void add(const RunRecord& run, double value) { add(run.key.survey, run.log_hash, value); }
  /// What two runs of one trial differ by.
  void add(const RunRecord& one, const RunRecord& other, double difference) {
    add(one.key.survey, one.log_hash + other.log_hash, difference);
  }

  const ClusteredValues& values() const { return values_; }

 private:
  void add(std::size_t survey, const std::string& log, double value) {
    const bool is_new = is_cost_ || log.empty() || seen_.emplace(survey, log, value).second;
    if (is_new) values_[survey].push_back(value);
  }

  bool is_cost_;
  ClusteredValues values_;
  std::set<std::tuple<std::size_t, std::string, double>> seen_;
};

}  // namespace fathom

#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "fathom/evaluation/clustered.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// A metric of runs by survey, each draw once: repeats of one measurement log that all say the
/// same, but for rounding, are one result, however often it is repeated. Where one of them says
/// another thing something was drawn, and each is a draw. Runs without the hash of a log are apart,
/// and of a cost every repeat is a measurement.
class DistinctValues {
 public:
  explicit DistinctValues(const std::string& metric) : is_cost_(is_cost_metric(metric)) {}

  void add(const RunRecord& run, double value) {
    add(run.key.survey, run.log_hash, value, std::abs(value));
  }
  /// What two runs of one trial differ by: `a` − `b`.
  void add(const RunRecord& one, const RunRecord& other, double a, double b) {
    add(one.key.survey, one.log_hash + other.log_hash, a - b, std::max(std::abs(a), std::abs(b)));
  }

  /// In the order in which they were added.
  ClusteredValues values() const {
    ClusteredValues values;
    std::set<Log> seen;
    for (const auto& [log, value] : all_) {
      const bool is_repeat = !seen.insert(log).second;
      if (!is_repeat || !logs_.at(log).is_one_result) values[log.first].push_back(value);
    }
    return values;
  }

 private:
  using Log = std::pair<std::size_t, std::string>;  // survey and hash
  struct Repeats {
    double first = 0.0;
    bool is_one_result = true;
  };

  void add(std::size_t survey, const std::string& hash, double value, double size) {
    const Log log{survey, hash};
    Repeats& repeats =
        logs_.try_emplace(log, Repeats{value, !is_cost_ && !hash.empty()}).first->second;
    // Programs that sum in any order repeat themselves to some digits.
    constexpr double kRounding = 1e-9;
    const bool is_same =
        value == repeats.first || std::abs(value - repeats.first) <= kRounding * size;
    repeats.is_one_result = repeats.is_one_result && is_same;
    all_.emplace_back(log, value);
  }

  bool is_cost_;
  std::vector<std::pair<Log, double>> all_;
  std::map<Log, Repeats> logs_;
};

}  // namespace fathom

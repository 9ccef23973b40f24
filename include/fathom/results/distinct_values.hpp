#pragma once

#include <cstddef>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "fathom/evaluation/clustered.hpp"

namespace fathom {

/// A figure of runs by survey, each draw once: what repeats of one measurement log say alike is one
/// result, however often it is repeated. Runs without the hash of a log are apart.
class DistinctValues {
 public:
  void add(std::size_t survey, const std::string& log_hash, double value) {
    const bool is_new = log_hash.empty() || seen_.emplace(survey, log_hash, value).second;
    if (is_new) values_[survey].push_back(value);
  }

  const ClusteredValues& values() const { return values_; }

 private:
  ClusteredValues values_;
  std::set<std::tuple<std::size_t, std::string, double>> seen_;
};

}  // namespace fathom

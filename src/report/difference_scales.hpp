#pragma once

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "ranking.hpp"
#include "scaled_unit.hpp"

namespace fathom {

/// One unit for all differences that a sentence names, but for those that would be less than a
/// hundredth of it. They have intervals.
class DifferenceScales {
 public:
  DifferenceScales(const std::vector<const RankedEstimator*>& named, std::string unit)
      : unit_(std::move(unit)) {
    double greatest = 0.0;
    for (const RankedEstimator* one : named) greatest = std::max(greatest, greatest_of(*one));
    shared_ = reading_unit(unit_, greatest);
  }

  ScaledUnit of(const RankedEstimator& one) const {
    const double greatest = greatest_of(one);
    return greatest * shared_.factor < 0.01 ? reading_unit(unit_, greatest) : shared_;
  }

 private:
  static double greatest_of(const RankedEstimator& one) {
    const Interval& interval = *one.difference->interval;
    return std::max(std::abs(interval.low), std::abs(interval.high));
  }

  std::string unit_;
  ScaledUnit shared_;
};

}  // namespace fathom

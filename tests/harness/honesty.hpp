#pragma once

#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <gtest/gtest.h>

#include "fathom/evaluation/consistency.hpp"

namespace fathom::test {

/// Means of NEES over trials, each keyframe against the interval of so many trials.
class Honesty {
 public:
  /// The keyframes of one estimate share errors, so that one study has few that are independent;
  /// many small groups of trials have many.
  static constexpr std::size_t kGroup = 10;

  void add(const Consistency& trial) {
    anees_.push_back(trial.anees);
    sums_.resize(trial.pose_nees.size());
    for (std::size_t k = 0; k < sums_.size(); ++k) sums_[k] += trial.pose_nees[k];
    if (anees_.size() % kGroup != 0) return;
    const Interval interval = anees_interval(kGroup, 3, 0.95);
    for (double& sum : sums_) {
      if (interval.contains(sum / (3.0 * kGroup))) ++inside_;
      ++means_;
      sum = 0.0;
    }
  }

  void expect(const std::string& name) const {
    const auto count = static_cast<double>(anees_.size());
    const Eigen::Map<const Eigen::ArrayXd> anees(anees_.data(), static_cast<Eigen::Index>(count));
    const double variance = (anees - anees.mean()).square().sum() / (count - 1.0);
    EXPECT_NEAR(anees.mean(), 1.0, 3.0 * std::sqrt(variance / count)) << name;
    const double share = static_cast<double>(inside_) / static_cast<double>(means_);
    EXPECT_GE(share, 0.93) << name;
    EXPECT_LE(share, 0.97) << name;
  }

 private:
  std::vector<double> anees_;  // by trial
  std::vector<double> sums_;   // by keyframe, over the trials of the present group
  std::size_t inside_ = 0;
  std::size_t means_ = 0;
};

}  // namespace fathom::test

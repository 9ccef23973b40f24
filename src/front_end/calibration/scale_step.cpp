#include "scale_step.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "fathom/core/median.hpp"
#include "student_t.hpp"

namespace fathom {
namespace {

// Of the altitudes before a motion and after it, in the median of some.
double altitude_factor_at(const CalibrationInput& input, const SeenMotion& motion) {
  constexpr std::size_t kBeside = 5;
  std::vector<double> low;
  std::vector<double> high;
  for (std::size_t i = motion.from - std::min(motion.from, kBeside); i <= motion.from; ++i) {
    low.push_back(input.altitudes_m[i]);
  }
  for (std::size_t i = motion.to; i < std::min(input.altitudes_m.size(), motion.to + kBeside);
       ++i) {
    high.push_back(input.altitudes_m[i]);
  }
  return upper_median(high) / upper_median(low);
}

// A series that has one level up to an index, and another from there on.
struct TwoLevels {
  std::size_t split = 0;
  double before = 0.0;
  double after = 0.0;
  double sigma = 0.0;  // of their difference
};

// By least absolute deviations, with so many on either side.
TwoLevels two_levels(const std::vector<double>& values, std::size_t fewest) {
  const auto median_of = [&values](std::size_t begin, std::size_t end) {
    return upper_median({values.begin() + static_cast<std::ptrdiff_t>(begin),
                         values.begin() + static_cast<std::ptrdiff_t>(end)});
  };
  TwoLevels best;
  std::vector<double> least_off;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t split = fewest; split + fewest <= values.size(); ++split) {
    const TwoLevels levels{split, median_of(0, split), median_of(split, values.size()), 0.0};
    std::vector<double> off;
    off.reserve(values.size());
    for (std::size_t j = 0; j < values.size(); ++j) {
      off.push_back(std::abs(values[j] - (j < split ? levels.before : levels.after)));
    }
    const double sum = std::accumulate(off.begin(), off.end(), 0.0);
    if (!(sum < least)) continue;
    least = sum;
    best = levels;
    least_off = std::move(off);
  }
  constexpr double kOfMedian = 1.2533;
  const auto count = static_cast<double>(values.size());
  const auto first = static_cast<double>(best.split);
  best.sigma = kOfMedian * upper_median(least_off) / kHalfNormalMedian *
               std::sqrt(1.0 / first + 1.0 / (count - first));
  return best;
}

}  // namespace

std::optional<SetUp::Step> find_step_of_scale(const CalibrationInput& input, const SetUpFit& fit) {
  constexpr std::size_t kFewest = 8;
  constexpr double kSigmas = 8.0;
  constexpr double kLeast = 0.05;
  std::vector<double> log_ratios;
  std::vector<std::size_t> moved;
  for (const SetUpFit::Motion& motion : fit.each) {
    const double length_m = input.motions[motion.index].camera.position().norm();
    if (motion.length_ratio > 0.0 && length_m > 3.0 * fit.sigma_m) {
      log_ratios.push_back(std::log(motion.length_ratio));
      moved.push_back(motion.index);
    }
  }
  if (moved.size() < 2 * kFewest) return std::nullopt;
  const TwoLevels levels = two_levels(log_ratios, kFewest);
  const Estimated log_factor{levels.before - levels.after, levels.sigma};
  if (!log_factor.is_off(0.0, kSigmas, kLeast)) return std::nullopt;
  const SeenMotion& first = input.motions[moved[levels.split]];
  const double factor = std::exp(log_factor.value);
  return SetUp::Step{
      first.from_ns, {factor, factor * levels.sigma}, altitude_factor_at(input, first)};
}

}  // namespace fathom

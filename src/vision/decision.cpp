#include "decision.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fmt/format.h>

#include "fathom/core/chi_squared.hpp"

namespace fathom {
namespace {

// P(X ≥ count) of a Poisson distribution, by its relation to chi squared (Abramowitz and Stegun
// 26.4.21).
double poisson_tail(int count, double mean) {
  return count <= 0 ? 1.0 : chi_squared_cdf(2.0 * mean, 2.0 * count);
}

Evidence weigh_at(double error_m, const Hypothesis& best, const Rivals& rivals,
                  const MatchSet& nearest, const RegistrationOptions& options) {
  // Two matches make a motion, so any motion has two.
  constexpr int kAlways = 2;
  const DecisionTuning& tuning = options.tuning.decision;
  Evidence evidence;
  evidence.rival_places = kAlways;
  for (const Pose& rival : rivals.motions) {
    const PointPairs& pairs = rivals.matches.pairs();
    evidence.rival_places =
        std::max(evidence.rival_places, pairs.count_places(pairs.inliers(rival, error_m), error_m));
  }
  const std::vector<int> inliers = nearest.pairs().inliers(*best.motion, error_m);
  evidence.support = static_cast<int>(inliers.size());
  // As many as decide.
  const double outweigh = std::min(evidence.rival_places / tuning.rival_share, 1e6);
  evidence.places = nearest.pairs().count_places(
      inliers, error_m, std::max(tuning.most_places, static_cast<int>(outweigh) + 1));
  evidence.false_alarms = poisson_tail(evidence.places, evidence.rival_places);
  return evidence;
}

}  // namespace

Evidence weigh(const Hypothesis& best, const Rivals& rivals, const MatchSet& nearest,
               const RegistrationOptions& options) {
  const double coarse_m = *options.ransac.max_error_m;
  const double fine_m = coarse_m / options.tuning.decision.fine_divisor;
  const Evidence coarse = weigh_at(coarse_m, best, rivals, nearest, options);
  const Evidence fine = weigh_at(fine_m, best, rivals, nearest, options);
  return fine.false_alarms < coarse.false_alarms ? fine : coarse;
}

std::string reason_to_refuse(const Evidence& evidence, const RegistrationOptions& options) {
  const RansacOptions& ransac = options.ransac;
  const std::string agree = std::to_string(evidence.support) + " matches agree";
  if (evidence.support < ransac.min_inliers) {
    return fmt::format("{}, {} are needed", agree, ransac.min_inliers);
  }
  const std::string places = fmt::format("{}, in {} places", agree, evidence.places);
  if (evidence.places < ransac.min_places) {
    return fmt::format("{}, {} are needed", places, ransac.min_places);
  }
  const double most = options.decision.max_false_alarms;
  if (evidence.false_alarms > most) {
    std::array<char, 96> chance{};
    std::snprintf(chance.data(), chance.size(),
                  "; another motion has %d: by chance %.1g, above %.1g", evidence.rival_places,
                  evidence.false_alarms, most);
    return places + chance.data();
  }
  // By chance a motion would hardly have so many more; by a floor that repeats itself it may: which
  // of its equals a thing is taken for, its neighbours are taken for, too. What is nearer to the
  // camera than its altitude says agrees on another motion, too.
  const double most_share = options.tuning.decision.rival_share;
  if (evidence.rival_places > most_share * evidence.places) {
    return fmt::format(
        "{}; another motion has {}, more than {:g} of them: the floor repeats or has relief, an "
        "altitude is wrong, or something in view moves otherwise",
        places, evidence.rival_places, most_share);
  }
  return {};
}

}  // namespace fathom

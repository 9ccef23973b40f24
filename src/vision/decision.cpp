#include "decision.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "fathom/core/chi_squared.hpp"

namespace fathom {
namespace {

// P(X ≥ count) of a Poisson distribution, by its relation to chi squared (Abramowitz and Stegun
// 26.4.21).
double poisson_tail(int count, double mean) {
  return count <= 0 ? 1.0 : chi_squared_cdf(2.0 * mean, 2.0 * count);
}

Evidence weigh_at(const SupportedMotion& best, int rival_places, const MatchSet& nearest,
                  double error_m, double reach_m) {
  // Two matches make a motion, so any motion has two.
  constexpr int kAlways = 2;
  const std::vector<int> agreeing = nearest.pairs().agreeing(*best.motion, error_m);
  Evidence evidence;
  evidence.agreeing = static_cast<int>(agreeing.size());
  evidence.places = nearest.pairs().count_places(agreeing, error_m, kEnoughPlaces);
  evidence.rival_places = std::max(
      {kAlways, rival_places, most_places_elsewhere(*best.motion, nearest, reach_m, error_m)});
  evidence.false_alarms = poisson_tail(evidence.places, evidence.rival_places);
  return evidence;
}

}  // namespace

Evidence weigh(const SupportedMotion& best, const SupportedMotion& rival, const MatchSet& nearest,
               double max_error_m) {
  const double reach_m = kRivalReach * max_error_m;
  const Evidence coarse = weigh_at(best, rival.places, nearest, max_error_m, reach_m);
  const Evidence fine = weigh_at(best, 0, nearest, max_error_m / 3.0, reach_m);
  return fine.false_alarms < coarse.false_alarms ? fine : coarse;
}

std::string objection(const Evidence& evidence, const RansacOptions& ransac,
                      const DecisionOptions& decision) {
  const std::string agree = std::to_string(evidence.agreeing) + " matches agree";
  if (evidence.agreeing < ransac.min_inliers) {
    return agree + ", " + std::to_string(ransac.min_inliers) + " are needed";
  }
  const std::string places = agree + ", in " + std::to_string(evidence.places) + " places";
  if (evidence.places < ransac.min_places) {
    return places + ", " + std::to_string(ransac.min_places) + " are needed";
  }
  if (evidence.false_alarms > decision.max_false_alarms) {
    std::array<char, 96> chance{};
    std::snprintf(chance.data(), chance.size(),
                  "; another motion has %d: by chance %.1g, above %.1g", evidence.rival_places,
                  evidence.false_alarms, decision.max_false_alarms);
    return places + chance.data();
  }
  return {};
}

}  // namespace fathom

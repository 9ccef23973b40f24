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

Evidence weigh_at(double error_m, const Hypothesis& best, int rival_places, const MatchSet& nearest,
                  const RegistrationOptions& options) {
  // Two matches make a motion, so any motion has two.
  constexpr int kAlways = 2;
  const std::vector<int> inliers = nearest.pairs().inliers(*best.motion, error_m);
  Evidence evidence;
  evidence.support = static_cast<int>(inliers.size());
  evidence.places =
      nearest.pairs().count_places(inliers, error_m, options.tuning.decision.most_places);
  evidence.rival_places = std::max(
      {kAlways, rival_places, most_places_elsewhere(*best.motion, nearest, error_m, options)});
  evidence.false_alarms = poisson_tail(evidence.places, evidence.rival_places);
  return evidence;
}

}  // namespace

Evidence weigh(const Hypothesis& best, const Hypothesis& rival, const MatchSet& nearest,
               const RegistrationOptions& options) {
  const double coarse_m = *options.ransac.max_error_m;
  const double fine_m = coarse_m / options.tuning.decision.fine_divisor;
  const Evidence coarse = weigh_at(coarse_m, best, rival.places, nearest, options);
  const Evidence fine = weigh_at(fine_m, best, 0, nearest, options);
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
  return {};
}

}  // namespace fathom

#include "apps/registration_text.hpp"

#include <algorithm>
#include <cmath>

#include "apps/output.hpp"

namespace fathom {
namespace {

std::string line(const char* name, const std::string& value) {
  return printed("  %-16s ", name) + value + '\n';
}

// As many decimals as leave its uncertainty two digits.
std::string uncertain(double value, double sigma, const char* unit) {
  constexpr int kMost = 9;
  const int decimals =
      sigma > 0.0 ? std::clamp(1 - static_cast<int>(std::floor(std::log10(sigma))), 0, kMost)
                  : kMost;
  return printed("%9.*f%s%s +- %.*f", decimals, value, *unit == 0 ? "" : " ", unit, decimals,
                 sigma);
}

std::string verdict(const Registration& registration, double metres_per_pixel) {
  if (!registration.found) return "not found: " + registration.reason + '\n';
  const Pose& z = registration.motion;
  const auto number = [&](double value, const char* unit, int i) {
    return uncertain(value, std::sqrt(registration.covariance(i, i)), unit);
  };
  return "found: pose of B in the frame of A\n" + line("x", number(z.x, "m", 0)) +
         line("y", number(z.y, "m", 1)) + line("heading", number(z.theta, "rad", 2)) +
         line("rms of the pairs", printed("%9.4f m, %.2f pixels", registration.rms_m,
                                          registration.rms_m / metres_per_pixel));
}

std::string chance_text(double chance, double limit) {
  // Below this a double has lost digits, or is zero.
  constexpr double kLeast = 1e-300;
  const std::string number =
      chance < kLeast ? printed("below %.0e", kLeast) : printed("%.1e", chance);
  return number + printed(", at most %.0e is allowed", limit);
}

std::string scale_text(const Evidence& evidence) {
  constexpr double kSigmas = 4.0;
  constexpr double kShare = 0.02;
  const double off = std::abs(evidence.scale - 1.0);
  const bool is_off = off > kSigmas * evidence.scale_sigma && off > kShare;
  return uncertain(evidence.scale, evidence.scale_sigma, "") + ", " +
         (is_off ? "not applied: the altitudes may be wrong" : "as the altitudes say");
}

std::string by_false_alarms(const Evidence& evidence, const RegistrationOptions& options) {
  if (evidence.places == 0) return line("nearest pairs", "no two matches agree on a motion");
  return line("nearest pairs",
              printed("%d agree, in %d places", evidence.support, evidence.places)) +
         line("other motions", printed("%d places at most", evidence.rival_places)) +
         line("by chance", chance_text(evidence.false_alarms, options.decision.max_false_alarms));
}

// RANSAC counts places no further than they are needed.
std::string by_inliers(const Evidence& evidence, const RansacOptions& ransac) {
  const char* more = evidence.places == ransac.min_places ? " or more" : "";
  return line("agreeing",
              printed("%d of them, %d are needed; in %d%s places, %d are needed", evidence.support,
                      ransac.min_inliers, evidence.places, more, ransac.min_places));
}

}  // namespace

std::string registration_text(const FloorFeatures& a, const FloorFeatures& b,
                              const RegistrationOptions& options,
                              const Registration& registration) {
  const Evidence& evidence = registration.evidence;
  const double metres_per_pixel =
      std::min(a.viewpoint.metres_per_pixel, b.viewpoint.metres_per_pixel);
  std::string text = verdict(registration, metres_per_pixel) + "evidence\n" +
                     line("features", printed("%zu in A, %zu in B", a.size(), b.size())) +
                     line("matches", printed("%zu, each distinct from the next best",
                                             registration.putative.size()));
  text += options.decision.method == DecisionOptions::Method::inliers
              ? by_inliers(evidence, options.ransac)
              : by_false_alarms(evidence, options);
  if (registration.found) text += line("scale", scale_text(evidence));
  return text;
}

}  // namespace fathom

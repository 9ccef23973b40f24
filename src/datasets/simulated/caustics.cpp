#include "caustics.hpp"

#include <cmath>
#include <numbers>

#include "fathom/core/random.hpp"

namespace fathom {

Caustics::Caustics(double share, std::uint64_t seed) : share_(static_cast<float>(share)) {
  constexpr double kTurn = 2.0 * std::numbers::pi;
  RandomStream stream(seed, "caustics");
  const auto draw = [&](double shortest_m, double longest_m) {
    const double heading = stream.uniform(0.0, kTurn);
    const double number = kTurn / stream.uniform(shortest_m, longest_m);
    return Wave{
        Eigen::Vector2d(number * std::cos(heading), number * std::sin(heading)).cast<float>(),
        static_cast<float>(stream.uniform(0.0, kTurn))};
  };
  for (Wave& wave : waves_) wave = draw(0.35, 0.7);
  for (Wave& warp : warps_) warp = draw(0.8, 1.6);
}

float Caustics::Wave::at(const Eigen::Vector2f& point, float warp_rad) const {
  return std::sin(radians_per_metre.dot(point) + phase_rad + warp_rad);
}

float Caustics::gain(const Eigen::Vector2f& point) const {
  const float warp = 1.5F * warps_[0].at(point, 0.0F);
  const float other_warp = 1.5F * warps_[1].at(point, 0.0F);
  const float sum = waves_[0].at(point, warp) + waves_[1].at(point, other_warp) +
                    waves_[2].at(point, warp - other_warp);
  // Bright where the waves cancel: lines, with cells between them.
  const float ridge = 1.0F - std::abs(sum) / 3.0F;
  return 1.0F + share_ * (2.0F * ridge * ridge - 1.0F);
}

}  // namespace fathom

#include "heading_track.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "fathom/core/median.hpp"
#include "student_t.hpp"

namespace fathom {
namespace {

constexpr double kNsPerSecond = 1e9;

// Residuals of Student's t: their scale, most likely, and how likely they are with it.
struct Likely {
  double sigma = 0.0;
  double log_density = 0.0;

  static constexpr StudentT kT{1.0};
  double squared(double off) const { return off * off / (sigma * sigma); }
};

Likely likely(const std::vector<double>& off) {
  constexpr int kRounds = 20;
  std::vector<double> sizes;
  sizes.reserve(off.size());
  for (const double one : off) sizes.push_back(std::abs(one));
  Likely found{std::max(1e-9, upper_median(sizes) / kHalfNormalMedian), 0.0};
  const auto count = static_cast<double>(off.size());
  for (int round = 0; round < kRounds; ++round) {
    double squares = 0.0;
    for (const double one : off) squares += Likely::kT.weight(found.squared(one)) * one * one;
    found.sigma = std::max(1e-9, std::sqrt(squares / count));
  }
  found.log_density = -count * std::log(found.sigma);
  for (const double one : off) {
    found.log_density += Likely::kT.log_density(found.squared(one));
  }
  return found;
}

// What turns from reading to reading leave over, in the sense found; nothing of those that dead
// reckoning does not cover.
std::vector<std::optional<double>> left_over(const HeadingTrack& said, const OdometryTrack& track,
                                             double sense, double offset_s) {
  constexpr double kSpan_s = 0.4;
  std::vector<std::optional<double>> left;
  for (const auto& [from, to] : spans(said, kSpan_s)) {
    const auto reckoned = reckoned_turn(said, track, from, to, offset_s);
    left.push_back(reckoned ? std::optional(wrap_angle(said.turn_rad(from, to) - sense * *reckoned))
                            : std::nullopt);
  }
  return left;
}

std::vector<double> known(const std::vector<std::optional<double>>& values) {
  std::vector<double> some;
  for (const auto& value : values) {
    if (value) some.push_back(*value);
  }
  return some;
}

}  // namespace

std::vector<std::pair<std::size_t, std::size_t>> spans(const HeadingTrack& said, double span_s) {
  std::vector<std::pair<std::size_t, std::size_t>> spans;
  std::size_t from = 0;
  for (std::size_t to = 1; to < said.size(); ++to) {
    if (static_cast<double>(said.time_ns(to) - said.time_ns(from)) < kNsPerSecond * span_s)
      continue;
    spans.emplace_back(from, to);
    from = to;
  }
  return spans;
}

std::optional<double> reckoned_turn(const HeadingTrack& said, const OdometryTrack& track,
                                    std::size_t from, std::size_t to, double offset_s) {
  const auto shift_ns = static_cast<std::int64_t>(std::llround(kNsPerSecond * offset_s));
  const auto motion = track.motion(said.time_ns(from) + shift_ns, said.time_ns(to) + shift_ns);
  return motion ? std::optional(motion->theta) : std::nullopt;
}

std::optional<Estimated> clock_of(const HeadingTrack& said, const OdometryTrack& track,
                                  double sense) {
  constexpr double kMost_s = 5.0;
  constexpr double kStep_s = 0.1;
  constexpr double kEnough = 0.7;
  constexpr std::size_t kFewest = 10;
  constexpr int kRounds = 5;
  const auto left_at = [&](double offset_s) { return left_over(said, track, sense, offset_s); };
  const std::size_t all = known(left_at(0.0)).size();
  if (all < kFewest) return std::nullopt;
  double offset_s = 0.0;
  double best = -std::numeric_limits<double>::infinity();
  const int steps = static_cast<int>(std::lround(kMost_s / kStep_s));
  for (int step = -steps; step <= steps; ++step) {
    const double at_s = kStep_s * step;
    const std::vector<double> left = known(left_at(at_s));
    if (static_cast<double>(left.size()) < kEnough * static_cast<double>(all)) continue;
    const double each = likely(left).log_density / static_cast<double>(left.size());
    if (each > best) {
      best = each;
      offset_s = at_s;
    }
  }
  Estimated offset{offset_s, 0.0};
  for (int round = 0; round < kRounds; ++round) {
    const auto left = left_at(offset.value);
    const auto before = left_at(offset.value - 0.5 * kStep_s);
    const auto after = left_at(offset.value + 0.5 * kStep_s);
    const Likely scale = likely(known(left));
    double H = 0.0;
    double curvature = 0.0;
    double g = 0.0;
    double scores = 0.0;
    for (std::size_t i = 0; i < left.size(); ++i) {
      if (!left[i] || !before[i] || !after[i]) continue;
      const double J = (*after[i] - *before[i]) / kStep_s;
      const double r2 = scale.squared(*left[i]);
      const double weight = Likely::kT.weight(r2);
      H += weight * J * J;
      curvature += Likely::kT.curvature(r2) * J * J;
      g += weight * J * *left[i];
      scores += std::pow(weight * J * *left[i], 2);
    }
    if (!(H > 0.0 && curvature > 0.0)) return std::nullopt;
    offset.value -= std::clamp(g / H, -kStep_s, kStep_s);
    offset.sigma = std::sqrt(scores) / curvature;
  }
  return offset;
}

}  // namespace fathom

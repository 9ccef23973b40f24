#include <algorithm>
#include <cmath>

#include "fathom/core/median.hpp"
#include "heading_track.hpp"
#include "set_up.hpp"
#include "student_t.hpp"

namespace fathom {
namespace {

constexpr double kFarSigmas = 10.0;  // between fixes whose way has a direction

// Two turns over the same time: of dead reckoning and of a source, as angles or as areas.
struct Turned {
  double reckoned = 0.0;
  double said = 0.0;
};

// Of the slope, the larger of two: that of equal noise, and the sandwich, each residual as if left
// out (HC3), since of few turns each bends the slope towards itself.
double slope_sigma(const std::vector<Turned>& turned, const std::vector<double>& weights,
                   double slope, double xx) {
  double scores = 0.0;
  double squares = 0.0;
  double sum = -1.0;
  for (std::size_t i = 0; i < turned.size(); ++i) {
    const double x = turned[i].reckoned;
    const double off = turned[i].said - slope * x;
    const double others = 1.0 - weights[i] * x * x / xx;
    const double score = weights[i] * x * off / std::max(1e-9, others);
    scores += score * score;
    squares += weights[i] * off * off;
    sum += weights[i];
  }
  return std::sqrt(std::max(scores / xx, squares / sum) / xx);
}

// Said over reckoned, through zero; wild ones weigh less. Nothing where dead reckoning turns too
// little against what is left.
std::optional<Estimated> slope_of(const std::vector<Turned>& turned) {
  constexpr std::size_t kFewest = 5;
  constexpr int kRounds = 20;
  constexpr double kSigmas = 5.0;
  if (turned.size() < kFewest) return std::nullopt;
  Estimated slope;
  std::vector<double> weights(turned.size(), 1.0);
  for (int round = 0; round < kRounds; ++round) {
    double xx = 0.0;
    double xy = 0.0;
    for (std::size_t i = 0; i < turned.size(); ++i) {
      xx += weights[i] * turned[i].reckoned * turned[i].reckoned;
      xy += weights[i] * turned[i].reckoned * turned[i].said;
    }
    if (!(xx > 0.0)) return std::nullopt;
    slope.value = xy / xx;
    std::vector<double> off;
    off.reserve(turned.size());
    for (const Turned& one : turned) off.push_back(std::abs(one.said - slope.value * one.reckoned));
    const double sigma = std::max(1e-9, upper_median(off) / kHalfNormalMedian);
    slope.sigma = slope_sigma(turned, weights, slope.value, xx);
    for (std::size_t i = 0; i < turned.size(); ++i) {
      const double in_sigmas = off[i] / (3.0 * sigma);
      weights[i] = 1.0 / (1.0 + in_sigmas * in_sigmas);
    }
  }
  if (!(std::abs(slope.value) > kSigmas * slope.sigma)) return std::nullopt;
  return slope;
}

// By spans, or the source's own interval. Of half a turn nobody knows which way round it was.
std::vector<Turned> turned(const HeadingTrack& said, const OdometryTrack& track, double span_s) {
  constexpr double kMostTurn_rad = 2.5;
  std::vector<Turned> turned;
  for (const auto& [from, to] : spans(said, span_s)) {
    const auto reckoned = reckoned_turn(said, track, from, to, 0.0);
    const double turn_rad = said.turn_rad(from, to);
    if (reckoned && std::abs(turn_rad) < kMostTurn_rad && std::abs(*reckoned) < kMostTurn_rad) {
      turned.push_back({*reckoned, turn_rad});
    }
  }
  return turned;
}

TurnComparison compared(const std::string& source, const HeadingTrack& said,
                        const OdometryTrack& track) {
  // Some five seconds, of a short survey a twelfth of it: long enough to turn. Where both corners
  // of each U-turn fall into one span, shorter ones.
  constexpr double kSpan_s = 5.0;
  constexpr double kSpans = 12.0;
  constexpr int kHalvings = 4;
  if (said.size() < 2) return {};
  const double all_s = 1e-9 * static_cast<double>(said.time_ns(said.size() - 1) - said.time_ns(0));
  double span_s = std::min(kSpan_s, all_s / kSpans);
  for (int i = 0; i < kHalvings; ++i, span_s *= 0.5) {
    if (const auto slope = slope_of(turned(said, track, span_s))) {
      return {source, *slope, std::nullopt};
    }
  }
  return {};
}

// Of ground truth, whose noise is not told: that of a long way's ends does not matter.
std::vector<PositionFix> positions_of(const std::vector<StampedPose>& truth) {
  constexpr double kWays = 60.0;
  double path_m = 0.0;
  for (std::size_t k = 1; k < truth.size(); ++k) {
    path_m += (truth[k].pose.position() - truth[k - 1].pose.position()).norm();
  }
  const double sigma_m = path_m / kWays / kFarSigmas;
  std::vector<PositionFix> fixes;
  fixes.reserve(truth.size());
  for (const StampedPose& pose : truth) {
    fixes.push_back(
        {pose.time_ns, pose.pose.position(), sigma_m * sigma_m * Eigen::Matrix2d::Identity()});
  }
  return fixes;
}

// Twice the areas of the triangles of each three fixes, far enough apart for their noise: mirrored
// paths have them negative.
std::vector<Turned> areas(const std::vector<PositionFix>& fixes, const OdometryTrack& track) {
  std::vector<const PositionFix*> corners;
  std::vector<Turned> areas;
  for (const PositionFix& fix : fixes) {
    const double far_m = kFarSigmas * std::sqrt(0.5 * fix.covariance.trace());
    if (!corners.empty() && (fix.position_m - corners.back()->position_m).norm() < far_m) continue;
    corners.push_back(&fix);
    if (corners.size() < 3) continue;
    const PositionFix& a = *corners[corners.size() - 3];
    const PositionFix& b = *corners[corners.size() - 2];
    const auto ab = track.motion(a.time_ns, b.time_ns);
    const auto ac = track.motion(a.time_ns, fix.time_ns);
    if (!ab || !ac) continue;
    const auto area = [](const Eigen::Vector2d& u, const Eigen::Vector2d& v) {
      return u.x() * v.y() - u.y() * v.x();
    };
    areas.push_back({area(ab->position(), ac->position()),
                     area(b.position_m - a.position_m, fix.position_m - a.position_m)});
  }
  return areas;
}

}  // namespace

TurnComparison compare_with_truth(const CalibrationInput& input, const OdometryTrack& track) {
  HeadingTrack truth;
  for (const StampedPose& pose : input.references) truth.add(pose.time_ns, pose.pose.theta);
  return compared("ground truth", truth, track);
}

std::vector<TurnComparison> compare_turns(const CalibrationInput& input,
                                          const OdometryTrack& track) {
  std::vector<TurnComparison> comparisons;
  const auto add = [&comparisons](TurnComparison comparison) {
    if (!comparison.source.empty()) comparisons.push_back(std::move(comparison));
  };
  add(compare_with_truth(input, track));
  if (!comparisons.empty()) {
    const auto slope = slope_of(areas(positions_of(input.references), track));
    if (slope) add({kTruthPath, *slope, std::nullopt});
  }
  HeadingTrack compass;
  for (const MeasuredHeading& heading : input.readings.headings) {
    compass.add(heading.time_ns, heading.heading_rad);
  }
  TurnComparison of_compass = compared("compass0", compass, track);
  if (!of_compass.source.empty()) {
    of_compass.time_offset_s = clock_of(compass, track, of_compass.slope.value < 0.0 ? -1.0 : 1.0);
  }
  add(std::move(of_compass));
  // The lever arm of the antenna is short against the triangles.
  if (const auto slope = slope_of(areas(input.readings.fixes, track))) {
    add({"position0", *slope, std::nullopt});
  }
  return comparisons;
}

}  // namespace fathom

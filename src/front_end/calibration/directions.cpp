#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <utility>

#include <Eigen/Geometry>

#include "fathom/core/median.hpp"
#include "fathom/core/text.hpp"
#include "findings.hpp"
#include "set_up.hpp"
#include "student_t.hpp"

namespace fathom {
namespace {

// A way as dead reckoning and as a source have it, in axes of the body at its beginning.
struct Ways {
  Eigen::Vector2d reckoned = Eigen::Vector2d::Zero();
  Eigen::Vector2d said = Eigen::Vector2d::Zero();

  double weight() const { return reckoned.norm() * said.norm(); }
  double turn_rad() const {
    return std::atan2(reckoned.x() * said.y() - reckoned.y() * said.x(), reckoned.dot(said));
  }
};

// The angle from the reckoned ways to those of the source: of their mean direction, long ways and
// those that are near it weigh more.
std::optional<Estimated> turn_of(const std::vector<Ways>& ways) {
  constexpr std::size_t kFewest = 5;
  constexpr int kRounds = 20;
  if (ways.size() < kFewest) return std::nullopt;
  std::vector<double> weights(ways.size(), 1.0);
  Estimated turn;
  for (int round = 0; round < kRounds; ++round) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    double all = 0.0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      const double weight = weights[i] * ways[i].weight();
      sum += weight * Eigen::Vector2d(std::cos(ways[i].turn_rad()), std::sin(ways[i].turn_rad()));
      all += weight;
    }
    if (!(all > 0.0)) return std::nullopt;
    turn.value = std::atan2(sum.y(), sum.x());
    std::vector<double> off;
    off.reserve(ways.size());
    double squares = 0.0;
    for (std::size_t i = 0; i < ways.size(); ++i) {
      off.push_back(std::abs(wrap_angle(ways[i].turn_rad() - turn.value)));
      squares += std::pow(weights[i] * ways[i].weight() * off[i], 2);
    }
    const auto count = static_cast<double>(ways.size());
    turn.sigma = std::sqrt(squares * count / (count - 1.0)) / all;
    const double scale = std::max(1e-6, upper_median(off) / kHalfNormalMedian);
    for (std::size_t i = 0; i < ways.size(); ++i) {
      weights[i] = 1.0 / (1.0 + std::pow(off[i] / (3.0 * scale), 2));
    }
  }
  return turn;
}

// Of ground truth over ways that are long against the step between two of its poses.
std::vector<Ways> ways_of_truth(const std::vector<StampedPose>& truth, const OdometryTrack& track) {
  constexpr std::size_t kWays = 60;
  std::vector<Ways> ways;
  const std::size_t span = std::max<std::size_t>(1, truth.size() / kWays);
  for (std::size_t k = span; k < truth.size(); k += span) {
    const StampedPose& from = truth[k - span];
    const StampedPose& to = truth[k];
    const auto motion = track.motion(from.time_ns, to.time_ns);
    if (motion) ways.push_back({motion->position(), between(from.pose, to.pose).position()});
  }
  return ways;
}

// The compass's heading at a time, of readings by rising time: the nearest one, brought there by
// dead reckoning.
std::optional<double> heading_at(std::int64_t time_ns, double sense,
                                 const std::vector<MeasuredHeading>& headings,
                                 const OdometryTrack& track) {
  constexpr std::int64_t kFar_ns = 2'000'000'000;
  if (headings.empty()) return std::nullopt;
  const auto distance = [time_ns](const MeasuredHeading& reading) {
    return std::abs(reading.time_ns - time_ns);
  };
  auto nearest = std::ranges::lower_bound(headings, time_ns, {}, &MeasuredHeading::time_ns);
  const bool is_after_all = nearest == headings.end();
  if (is_after_all ||
      (nearest != headings.begin() && distance(*std::prev(nearest)) < distance(*nearest))) {
    --nearest;
  }
  if (distance(*nearest) > kFar_ns) return std::nullopt;
  const auto motion = track.motion(nearest->time_ns, time_ns);
  if (!motion) return std::nullopt;
  return sense * nearest->heading_rad + motion->theta;
}

// Of fixes far enough apart for their noise, seen from the heading of the compass.
std::vector<Ways> ways_of_fixes(const AbsoluteReadings& readings, double sense,
                                const OdometryTrack& track) {
  constexpr double kSigmas = 10.0;
  std::vector<Ways> ways;
  const PositionFix* from = nullptr;
  for (const PositionFix& fix : readings.fixes) {
    if (from == nullptr) from = &fix;
    const double far_m = kSigmas * std::sqrt(0.5 * fix.covariance.trace());
    const Eigen::Vector2d way = fix.position_m - from->position_m;
    if (way.norm() < far_m) continue;
    const auto motion = track.motion(from->time_ns, fix.time_ns);
    const auto heading = heading_at(from->time_ns, sense, readings.headings, track);
    if (motion && heading) {
      ways.push_back({motion->position(), Eigen::Rotation2Dd(-*heading) * way});
    }
    from = &fix;
  }
  return ways;
}

// How many times as long a source's ways are as those of dead reckoning: of the middle ones.
std::optional<double> length_of(const std::vector<Ways>& ways) {
  constexpr std::size_t kFewest = 5;
  if (ways.size() < kFewest) return std::nullopt;
  std::vector<double> said_m;
  std::vector<double> reckoned_m;
  for (const Ways& way : ways) {
    said_m.push_back(way.said.norm());
    reckoned_m.push_back(way.reckoned.norm());
  }
  const double reckoned = upper_median(reckoned_m);
  return reckoned > 0.0 ? std::optional(upper_median(said_m) / reckoned) : std::nullopt;
}

// Over a twelfth of all fixes each, so that their noise is little. Directions are of no matter.
std::vector<Ways> lengths_of_fixes(const std::vector<PositionFix>& fixes,
                                   const OdometryTrack& track) {
  constexpr std::size_t kWays = 12;
  std::vector<Ways> ways;
  const std::size_t span = std::max<std::size_t>(1, fixes.size() / kWays);
  for (std::size_t i = span; i < fixes.size(); ++i) {
    const auto motion = track.motion(fixes[i - span].time_ns, fixes[i].time_ns);
    if (!motion) continue;
    ways.push_back({motion->position(), fixes[i].position_m - fixes[i - span].position_m});
  }
  return ways;
}

// Whether a source turns the way that dead reckoning does; 0 where it does not say.
double sense_of(const std::vector<TurnComparison>& turns, const char* source) {
  const auto found = std::ranges::find(turns, source, &TurnComparison::source);
  return found == turns.end() ? 0.0 : std::copysign(1.0, found->slope.value);
}

}  // namespace

std::vector<DirectionComparison> compare_directions(const CalibrationInput& input,
                                                    const OdometryTrack& track,
                                                    const std::vector<TurnComparison>& turns) {
  std::vector<DirectionComparison> directions;
  // Axes that turn opposite ways are mirrored, which comes first.
  if (sense_of(turns, "ground truth") > 0.0 && sense_of(turns, kTruthPath) >= 0.0) {
    if (const auto turn = turn_of(ways_of_truth(input.references, track))) {
      directions.push_back({"ground truth", *turn});
    }
  }
  const double of_compass = sense_of(turns, "compass0");
  if (of_compass != 0.0 && sense_of(turns, "position0") > 0.0) {
    if (const auto turn = turn_of(ways_of_fixes(input.readings, of_compass, track))) {
      directions.push_back({"position0", *turn});
    }
  }
  return directions;
}

void find_lengths(const CalibrationInput& input, const OdometryTrack& track, double registered,
                  std::vector<std::string>& findings) {
  // A unit of length that is another; noise of fixes makes short ways longer, but not by so much.
  constexpr double kGross = 50.0;
  const auto is_gross = [](double factor) { return factor > kGross || factor < 1.0 / kGross; };
  for (const auto& [source, ways] :
       {std::pair("ground truth", ways_of_truth(input.references, track)),
        std::pair("position0", lengths_of_fixes(input.readings.fixes, track))}) {
    const auto length = length_of(ways);
    // Against pictures, too: else dead reckoning is what is off.
    if (!length || !is_gross(*length) || !is_gross(*length / registered)) continue;
    findings.push_back(
        fmt::format("ways of {} are {} times as long as those of dead reckoning and pictures{}; "
                    "write its positions in metres",
                    source, short_number(*length, 4), named_factor(*length)));
  }
}

}  // namespace fathom

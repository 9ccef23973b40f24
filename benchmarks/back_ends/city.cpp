#include "city.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "benchmarks/noisy_motion.hpp"

namespace fathom::benchmarks {
namespace {

constexpr std::size_t kStreetKeyframes = 3;
constexpr double kSpacingM = 5.0;
constexpr std::size_t kVisits = 3;

struct Direction {
  int x;
  int y;
};

// East, north, west, south: a quarter to the left each.
constexpr std::array<Direction, 4> kDirections{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

// Where the drive is, and where to.
struct Drive {
  int x;
  int y;
  int heading = 0;  ///< in kDirections

  Pose pose(double steps) const {
    const Direction& d = kDirections[static_cast<std::size_t>(heading)];
    const double street_m = kSpacingM * static_cast<double>(kStreetKeyframes);
    return {street_m * x + kSpacingM * steps * d.x, street_m * y + kSpacingM * steps * d.y,
            wrap_angle(0.5 * M_PI * heading)};
  }
};

// Straight on, left or right, whatever does not leave the city.
void turn(Drive& drive, int side, RandomStream& walk) {
  std::array<int, 3> possible{};
  std::size_t count = 0;
  for (const int quarter : {0, 1, 3}) {
    const int heading = (drive.heading + quarter) % 4;
    const Direction& d = kDirections[static_cast<std::size_t>(heading)];
    const int x = drive.x + d.x;
    const int y = drive.y + d.y;
    if (x >= 0 && x < side && y >= 0 && y < side) possible[count++] = heading;
  }
  const auto chosen = static_cast<std::size_t>(walk.uniform(0.0, static_cast<double>(count)));
  drive.heading = possible[std::min(chosen, count - 1)];
}

}  // namespace

MeasurementLog city_streets(std::size_t keyframes) {
  RandomStream noise(1, "city");
  RandomStream walk(1, "walk");
  const std::size_t crossings = keyframes / (kStreetKeyframes * kVisits) + 1;
  const int side = std::max(2, static_cast<int>(std::sqrt(static_cast<double>(crossings))));
  const auto columns = static_cast<std::size_t>(side);
  std::vector<std::optional<std::size_t>> last_there(columns * columns);
  std::vector<Pose> truth;
  truth.reserve(keyframes);
  Drive drive{side / 2, side / 2};
  truth.push_back(drive.pose(0.0));
  MeasurementLog log(truth.front());
  last_there[static_cast<std::size_t>(drive.y) * columns + static_cast<std::size_t>(drive.x)] = 0;
  for (std::size_t k = 1; k < keyframes; ++k) {
    const std::size_t step = (k - 1) % kStreetKeyframes + 1;
    if (step == 1) turn(drive, side, walk);
    truth.push_back(drive.pose(static_cast<double>(step)));
    log.add_keyframe(noisy_motion(k - 1, truth[k - 1], k, truth[k], 0.02, 0.005, noise));
    if (step < kStreetKeyframes) continue;
    drive.x += kDirections[static_cast<std::size_t>(drive.heading)].x;
    drive.y += kDirections[static_cast<std::size_t>(drive.heading)].y;
    auto& last =
        last_there[static_cast<std::size_t>(drive.y) * columns + static_cast<std::size_t>(drive.x)];
    if (last) {
      log.add_registration(noisy_motion(*last, truth[*last], k, truth[k], 0.03, 0.01, noise));
    }
    last = k;
  }
  return log;
}

}  // namespace fathom::benchmarks

#include "benchmarks/graph_shapes.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "benchmarks/noisy_motion.hpp"

namespace fathom::benchmarks {
namespace {

struct Sigmas {
  double position_m = 0.0;
  double heading_rad = 0.0;
};

/// Registrations of a keyframe with older ones.
struct Sight {
  double reach_m = 0.0;
  std::size_t most = 0;         ///< of one keyframe
  std::size_t least_since = 0;  ///< keyframes between the two
};

Pose forward(const Pose& pose, double turn_rad, double distance_m) {
  return compose(pose,
                 {distance_m * std::cos(turn_rad), distance_m * std::sin(turn_rad), turn_rad});
}

MeasurementLog log_of(const std::vector<Pose>& truth,
                      const std::vector<std::vector<std::size_t>>& seen, const Sigmas& step,
                      const Sigmas& sight, RandomStream& noise) {
  MeasurementLog log(truth.front());
  for (std::size_t k = 1; k < truth.size(); ++k) {
    log.add_keyframe(
        noisy_motion(k - 1, truth[k - 1], k, truth[k], step.position_m, step.heading_rad, noise));
    for (const std::size_t from : seen[k]) {
      log.add_registration(
          noisy_motion(from, truth[from], k, truth[k], sight.position_m, sight.heading_rad, noise));
    }
  }
  return log;
}

// The newest of those in reach first, spread over their visits.
std::vector<std::vector<std::size_t>> seen_from(const std::vector<Pose>& truth,
                                                const Sight& sight) {
  std::map<std::pair<int, int>, std::vector<std::size_t>> cells;
  const auto cell_of = [&](const Pose& pose) {
    return std::pair(static_cast<int>(std::floor(pose.x / sight.reach_m)),
                     static_cast<int>(std::floor(pose.y / sight.reach_m)));
  };
  std::vector<std::vector<std::size_t>> seen(truth.size());
  for (std::size_t k = 0; k < truth.size(); ++k) {
    const auto [column, row] = cell_of(truth[k]);
    std::vector<std::size_t> near;
    for (int x = column - 1; x <= column + 1; ++x) {
      for (int y = row - 1; y <= row + 1; ++y) {
        for (const std::size_t i : cells[{x, y}]) {
          const bool is_near = (truth[i].position() - truth[k].position()).norm() < sight.reach_m;
          if (is_near && i + sight.least_since <= k) near.push_back(i);
        }
      }
    }
    std::ranges::sort(near, std::greater<>());
    const std::size_t stride =
        std::max<std::size_t>(1, near.size() / std::max<std::size_t>(1, sight.most));
    for (std::size_t i = 0; i < near.size() && seen[k].size() < sight.most; i += stride) {
      seen[k].push_back(near[i]);
    }
    std::ranges::reverse(seen[k]);
    cells[{column, row}].push_back(k);
  }
  return seen;
}

// On a square grid of crossings, at each left, right or straight on, back at its border.
std::vector<Pose> walk(std::size_t keyframes, int crossings, std::size_t between, double spacing_m,
                       RandomStream& random) {
  std::vector<Pose> truth{{}};
  int x = crossings / 2;
  int y = crossings / 2;
  int quarter = 0;
  while (truth.size() < keyframes) {
    const auto step = [&](int q) {
      return std::pair(q == 0 ? 1 : q == 2 ? -1 : 0, q == 1 ? 1 : q == 3 ? -1 : 0);
    };
    std::vector<int> possible;
    for (const int turn : {0, 1, 3}) {
      const auto [dx, dy] = step((quarter + turn) % 4);
      if (std::min(x + dx, y + dy) >= 0 && std::max(x + dx, y + dy) < crossings) {
        possible.push_back(turn);
      }
    }
    const int turn = possible[random.index(possible.size())];
    quarter = (quarter + turn) % 4;
    const auto [dx, dy] = step(quarter);
    x += dx;
    y += dy;
    Pose next = truth.back();
    next.theta = wrap_angle(0.5 * M_PI * quarter);
    for (std::size_t i = 0; i < between && truth.size() < keyframes; ++i) {
      next = forward(next, 0.0, spacing_m);
      truth.push_back(next);
    }
  }
  return truth;
}

}  // namespace

MeasurementLog drive(std::size_t keyframes, std::size_t loops, std::uint64_t seed) {
  RandomStream random(seed, "drive");
  const std::size_t lap = keyframes * 7 / 10;
  // Corners of a quarter each; what they lack of whole turns is spread over the lap.
  std::vector<double> turns(lap, 0.0);
  for (std::size_t k = 30 + random.index(90); k + 8 < lap; k += 38 + random.index(90)) {
    const double corner = random.uniform() < 0.6 ? 0.5 * M_PI : -0.5 * M_PI;
    for (std::size_t j = 0; j < 8; ++j) turns[k + j] = corner / 8.0;
  }
  double sum = 0.0;
  for (const double turn : turns) sum += turn;
  const double left = std::round(sum / (2.0 * M_PI)) * 2.0 * M_PI - sum;
  std::vector<Pose> first{{}};
  for (std::size_t k = 1; k <= lap; ++k) {
    first.push_back(forward(first.back(), turns[k - 1] + left / static_cast<double>(lap), 1.0));
  }
  const Eigen::Vector2d gap = first.back().position();
  std::vector<Pose> truth;
  std::vector<std::vector<std::size_t>> seen(keyframes);
  for (std::size_t k = 0; k < keyframes; ++k) {
    Pose pose = first[k % lap];
    const double share = static_cast<double>(k % lap) / static_cast<double>(lap);
    pose.x -= share * gap.x();
    pose.y -= share * gap.y();
    truth.push_back(pose);
  }
  const std::size_t again = keyframes - lap;
  for (std::size_t i = 0; i < loops; ++i) {
    const std::size_t k = lap + i * again / loops;
    seen[k].push_back(k - lap);
  }
  RandomStream noise(seed, "noise");
  return log_of(truth, seen, {0.02, 0.002}, {0.05, 0.005}, noise);
}

MeasurementLog office(std::size_t keyframes, std::uint64_t seed) {
  RandomStream random(seed, "office");
  RandomStream noise(seed, "noise");
  const std::vector<Pose> truth = walk(keyframes, 5, 8, 0.5, random);
  return log_of(truth, seen_from(truth, {1.5, 2, 20}), {0.01, 0.003}, {0.003, 0.0005}, noise);
}

MeasurementLog dense_streets(std::size_t keyframes, std::uint64_t seed) {
  RandomStream random(seed, "streets");
  RandomStream noise(seed, "noise");
  const int crossings =
      std::max(3, static_cast<int>(std::sqrt(static_cast<double>(keyframes) / 12.0)));
  const std::vector<Pose> truth = walk(keyframes, crossings, 3, 5.0, random);
  return log_of(truth, seen_from(truth, {8.0, 6, 2}), {0.05, 0.01}, {0.05, 0.01}, noise);
}

MeasurementLog circuit(std::size_t keyframes, std::uint64_t seed) {
  constexpr std::size_t kLap = 100;
  RandomStream noise(seed, "noise");
  std::vector<Pose> truth;
  std::vector<std::vector<std::size_t>> seen(keyframes);
  for (std::size_t k = 0; k < keyframes; ++k) {
    const double along = 2.0 * M_PI * static_cast<double>(k % kLap) / kLap;
    const Eigen::Vector2d tangent(-30.0 * std::sin(along), 15.0 * std::cos(along));
    truth.push_back(
        {30.0 * std::cos(along), 15.0 * std::sin(along), std::atan2(tangent.y(), tangent.x())});
    if (k >= kLap) seen[k].push_back(k - kLap);
  }
  return log_of(truth, seen, {0.03, 0.005}, {0.05, 0.01}, noise);
}

}  // namespace fathom::benchmarks

#include "cells.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "parallel.hpp"

namespace fathom::benchmarks {
namespace {

// One condition on one floor, as the rounds see it.
struct Scene {
  const Floor& floor;
  const test::Condition& condition;
  const Settings& settings;
  FloorRenderer renderer;
  RegistrationOptions registration;
};

struct Seen {
  View view;
  FloorFeatures features;
  double extraction_ms = 0.0;
};

Seen look(const Scene& scene, View view, RandomStream& stream) {
  test::draw_condition(view, scene.condition, stream);
  Seen seen{view, {}, 0.0};
  const cv::Mat picture = scene.renderer.render(view, scene.condition.effects);
  const Stopwatch watch;
  Features features = FeatureExtractor().extract(picture);
  seen.extraction_ms = watch.milliseconds();
  seen.features = on_floor(std::move(features), Camera(), view.altitude_m);
  return seen;
}

Verdict judge(const Answer& answer, const Pose& truth, const test::Condition& condition,
              double metres_per_pixel) {
  Verdict verdict;
  verdict.match_ms = answer.match_ms;
  verdict.solve_ms = answer.solve_ms;
  verdict.accepted = answer.motion.has_value();
  if (!verdict.accepted) return verdict;
  Eigen::Vector3d error = answer.motion->vector() - truth.vector();
  error.z() = wrap_angle(error.z());
  verdict.translation_m = error.head<2>().norm();
  verdict.translation_px = verdict.translation_m / metres_per_pixel;
  verdict.heading_rad = std::abs(error.z());
  const WrongLimits limits = wrong_limits(condition, metres_per_pixel);
  verdict.right =
      verdict.translation_m <= limits.translation_m && verdict.heading_rad <= limits.heading_rad;
  if (answer.covariance) verdict.nis = error.dot(answer.covariance->llt().solve(error));
  return verdict;
}

struct Round {
  std::vector<PairRecord> pairs;
  std::vector<double> extraction_ms;
};

Round run_round(const Scene& scene, std::size_t index) {
  const Camera camera;
  RandomStream poses(scene.settings.seed, "pairs of " + scene.floor.name, index);
  RandomStream looks(scene.settings.seed, "looks " + scene.floor.name + scene.condition.name,
                     index);
  const auto pairs = test::draw_pairs(camera, test::extent_of(scene.floor.world),
                                      buckets_of(scene.settings), poses);
  Round round;
  const Seen a = look(scene, pairs.front().a, looks);
  round.extraction_ms.push_back(a.extraction_ms);
  for (std::size_t k = 0; k < pairs.size(); ++k) {
    const Seen b = look(scene, pairs[k].b, looks);
    round.extraction_ms.push_back(b.extraction_ms);
    const double metres_per_pixel =
        std::min(a.view.altitude_m, b.view.altitude_m) / camera.model().fx;
    PairRecord record{k, pairs[k].overlap, index == 0, {}, {}};
    record.ours = judge(ours(a.features, b.features, scene.registration, index, index == 0),
                        pairs[k].motion(), scene.condition, metres_per_pixel);
    if (scene.settings.opencv) {
      record.opencv = judge(opencv(a.features, b.features, scene.registration, metres_per_pixel),
                            pairs[k].motion(), scene.condition, metres_per_pixel);
    }
    round.pairs.push_back(record);
  }
  return round;
}

}  // namespace

std::vector<test::Bucket> buckets_of(const Settings& settings) {
  const std::vector<test::Bucket> all = test::tenths();
  if (settings.buckets.empty()) return all;
  std::vector<test::Bucket> chosen;
  for (const int tenth : settings.buckets)
    chosen.push_back(all.at(static_cast<std::size_t>(tenth)));
  return chosen;
}

Cell run_cell(const Floor& floor, const test::Condition& condition, const Settings& settings) {
  const Scene scene{floor, condition, settings, renderer_for(floor, condition, settings.seed),
                    registration_options_for(condition, settings)};
  std::vector<Round> rounds(settings.pairs_per_cell);
  for_each_index(rounds.size(), settings.jobs,
                 [&](std::size_t i) { rounds[i] = run_round(scene, i); });
  Cell cell{floor.name, condition.name, {}, {}};
  for (const Round& round : rounds) {
    cell.pairs.insert(cell.pairs.end(), round.pairs.begin(), round.pairs.end());
    cell.extraction_ms.insert(cell.extraction_ms.end(), round.extraction_ms.begin(),
                              round.extraction_ms.end());
  }
  return cell;
}

}  // namespace fathom::benchmarks

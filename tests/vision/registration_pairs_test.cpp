// Registration of rendered pictures whose motion is known, a small part of the benchmark
// fathom_registration_benchmark (docs/registration_benchmark.md): recall, wrong motions, false
// acceptances and honesty. Default options throughout, of a level camera.

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "fathom/vision/registration.hpp"
#include "src/datasets/simulated/sea_floor.hpp"
#include "support/pairs/pairs.hpp"

namespace fathom {
namespace {

RegistrationOptions level() {
  RegistrationOptions options;
  options.covariance.tilt_sigma_rad = 0.0;
  return options;
}

constexpr double kSideM = 10.0;

const World& world_of(FloorKind kind) {
  static std::map<FloorKind, World> drawn;
  auto found = drawn.find(kind);
  if (found == drawn.end()) {
    const double pixel_m = floor_pixel_m(test::finest_pixel_of_pairs_m(Camera()));
    const int side = static_cast<int>(kSideM / pixel_m);
    found = drawn.emplace(kind, World{draw_sea_floor({side, side}, pixel_m, 7, kind), pixel_m, {}})
                .first;
  }
  return found->second;
}

FloorRenderer renderer_of(FloorKind kind) {
  const Camera camera;
  return {camera, ViewRays(camera), world_of(kind)};
}

FloorFeatures features_of(const FloorRenderer& renderer, const View& view,
                          const PictureEffects& effects) {
  return on_floor(FeatureExtractor().extract(renderer.render(view, effects)), Camera(),
                  view.altitude_m);
}

class EveryFloor : public ::testing::TestWithParam<std::pair<std::string, FloorKind>> {};

INSTANTIATE_TEST_SUITE_P(RegistrationPairs, EveryFloor,
                         ::testing::Values(std::pair("ripples", FloorKind::ripples),
                                           std::pair("mud", FloorKind::mud),
                                           std::pair("pebbles", FloorKind::pebbles),
                                           std::pair("patches", FloorKind::patches)),
                         [](const auto& entry) { return entry.param.first; });

TEST_P(EveryFloor, NoPairWithoutOverlapIsAccepted) {
  constexpr std::size_t kPool = 30;
  const auto& [name, kind] = GetParam();
  const FloorRenderer renderer = renderer_of(kind);
  RandomStream stream(1, "pool of " + name);
  std::vector<View> views;
  std::vector<FloorFeatures> features;
  for (std::size_t i = 0; i < kPool; ++i) {
    // Half of them at one heading: trains of ripples then lie alike.
    const auto heading_rad = i % 2 == 0 ? std::optional(0.7) : std::nullopt;
    views.push_back(
        test::draw_view(Camera(), test::extent_of(renderer.world()), heading_rad, stream));
    features.push_back(features_of(renderer, views.back(), {}));
  }
  std::size_t apart = 0;
  for (std::size_t i = 0; i < kPool; ++i) {
    for (std::size_t k = i + 1; k < kPool; ++k) {
      const Pose motion = between(views[i].pose, views[k].pose);
      if (footprint_overlap(Camera(), views[i].altitude_m, views[k].altitude_m, motion) > 0.0) {
        continue;
      }
      ++apart;
      const Registration result = register_pair(features[i], features[k], level(), i * kPool + k);
      EXPECT_FALSE(result.found) << i << " " << k << ": " << result.evidence.false_alarms;
    }
  }
  EXPECT_GT(apart, 200U);
}

struct Outcome {
  int found = 0;
  double nis = 0.0;  // mean over those found
};

// Pairs of one floor under a condition; each motion found is within 5 pixels and 0.02 rad.
Outcome registered(const std::string& name, FloorKind kind, const std::string& condition_name,
                   const std::vector<test::Bucket>& buckets, int rounds) {
  const test::Condition& condition = test::condition_named(condition_name);
  const FloorRenderer renderer = renderer_of(kind);
  Outcome outcome;
  for (int round = 0; round < rounds; ++round) {
    const auto index = static_cast<std::uint64_t>(round);
    RandomStream poses(1, "pairs of " + name, index);
    RandomStream looks(1, "looks " + name + condition_name, index);
    auto pairs = test::draw_pairs(Camera(), test::extent_of(renderer.world()), buckets, poses);
    test::draw_condition(pairs.front().a, condition, looks);
    const FloorFeatures a = features_of(renderer, pairs.front().a, condition.effects);
    for (test::ViewPair& pair : pairs) {
      test::draw_condition(pair.b, condition, looks);
      const FloorFeatures b = features_of(renderer, pair.b, condition.effects);
      const Registration result = register_pair(a, b, level(), index);
      if (!result.found) continue;
      ++outcome.found;
      Eigen::Vector3d error = result.motion.vector() - pair.motion().vector();
      error.z() = wrap_angle(error.z());
      const double metres_per_pixel =
          std::min(a.viewpoint.metres_per_pixel, b.viewpoint.metres_per_pixel);
      EXPECT_LT(error.head<2>().norm(), 5.0 * metres_per_pixel) << name << " " << condition_name;
      EXPECT_LT(std::abs(error.z()), 0.02) << name << " " << condition_name;
      outcome.nis += error.dot(result.covariance.llt().solve(error));
    }
  }
  outcome.nis /= std::max(1, outcome.found);
  return outcome;
}

const std::vector<test::Bucket> kBuckets{{0.3, 0.4}, {0.6, 0.7}};
constexpr int kRounds = 2;
constexpr int kPairs = 4;  // of a floor under a condition

TEST(RegistrationPairs, AreFoundRightAndHonestlyUnderEveryCondition) {
  for (const std::string condition : {"clean", "noise", "haze"}) {
    int found = 0;
    double nis = 0.0;
    for (const auto& [name, kind] :
         {std::pair("ripples", FloorKind::ripples), std::pair("mud", FloorKind::mud),
          std::pair("pebbles", FloorKind::pebbles), std::pair("patches", FloorKind::patches)}) {
      const Outcome outcome = registered(name, kind, condition, kBuckets, kRounds);
      found += outcome.found;
      nis += outcome.nis * outcome.found;
      RecordProperty(condition + "_" + name, outcome.found);
    }
    EXPECT_GE(found, condition == "clean" ? 15 : 14) << condition << ", of " << 4 * kPairs;
    EXPECT_GT(nis / found, 1.0) << condition;
    EXPECT_LT(nis / found, 7.0) << condition;
  }
}

}  // namespace
}  // namespace fathom

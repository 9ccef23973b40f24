#include "negatives.hpp"

#include <algorithm>
#include <atomic>
#include <numbers>
#include <utility>
#include <vector>

#include "contenders.hpp"
#include "parallel.hpp"

namespace fathom::benchmarks {
namespace {

using IndexPair = std::pair<std::size_t, std::size_t>;

std::vector<View> draw_pool(const Floor& floor, const Settings& settings) {
  RandomStream stream(settings.seed, "pool of " + floor.name);
  const double heading_rad = stream.uniform(-std::numbers::pi, std::numbers::pi);
  std::vector<View> views;
  for (std::size_t i = 0; i < settings.pool; ++i) {
    const bool alike = floor.name == "ripples" && i % 2 == 0;
    views.push_back(test::draw_view(Camera(), test::extent_of(floor.world),
                                    alike ? std::optional(heading_rad) : std::nullopt, stream));
  }
  return views;
}

std::vector<IndexPair> draw_apart(const std::vector<View>& views, const Floor& floor,
                                  const Settings& settings) {
  const Camera camera;
  std::vector<IndexPair> apart;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t k = i + 1; k < views.size(); ++k) {
      const double overlap = footprint_overlap(camera, views[i].altitude_m, views[k].altitude_m,
                                               between(views[i].pose, views[k].pose));
      if (overlap == 0.0) apart.emplace_back(i, k);
    }
  }
  RandomStream stream(settings.seed, "negatives of " + floor.name);
  for (std::size_t i = 0; i + 1 < apart.size(); ++i) {
    std::swap(apart[i], apart[i + stream.index(apart.size() - i)]);
  }
  if (apart.size() > settings.negatives) apart.resize(settings.negatives);
  return apart;
}

}  // namespace

Negatives run_negatives(const Floor& floor, const Settings& settings) {
  const test::Condition& clean = test::condition_named("clean");
  const FloorRenderer renderer = renderer_for(floor, clean, settings.seed);
  const std::vector<View> views = draw_pool(floor, settings);
  std::vector<FloorFeatures> features(views.size());
  for_each_index(views.size(), settings.jobs, [&](std::size_t i) {
    features[i] = on_floor(FeatureExtractor().extract(renderer.render(views[i])), Camera(),
                           views[i].altitude_m);
  });
  const std::vector<IndexPair> pairs = draw_apart(views, floor, settings);
  const RegistrationOptions options = registration_options_for(clean, settings);
  std::atomic<std::size_t> accepted = 0;
  std::atomic<std::size_t> accepted_by_opencv = 0;
  std::vector<double> false_alarms(pairs.size(), 1.0);
  for_each_index(pairs.size(), settings.jobs, [&](std::size_t i) {
    const auto& [from, to] = pairs[i];
    const Answer answer = ours(features[from], features[to], options, i, false);
    if (answer.motion) ++accepted;
    false_alarms[i] = answer.false_alarms;
    if (!settings.opencv) return;
    const double metres_per_pixel =
        std::min(views[from].altitude_m, views[to].altitude_m) / CameraModel().fx;
    if (opencv(features[from], features[to], options, metres_per_pixel).motion) {
      ++accepted_by_opencv;
    }
  });
  const double least =
      pairs.empty() ? 1.0 : *std::min_element(false_alarms.begin(), false_alarms.end());
  return {floor.name, pairs.size(), accepted, accepted_by_opencv, least};
}

}  // namespace fathom::benchmarks

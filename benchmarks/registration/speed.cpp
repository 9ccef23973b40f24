#include "speed.hpp"

#include <algorithm>

#include "contenders.hpp"
#include "summary.hpp"

namespace fathom::benchmarks {

Speed measure_speed(const Floor& floor, const Settings& settings) {
  constexpr std::size_t kRepeats = 25;
  const Camera camera;
  const test::Condition& clean = test::condition_named("clean");
  const FloorRenderer renderer = renderer_for(floor, clean, settings.seed);
  RandomStream stream(settings.seed, "speed");
  const test::ViewPair pair =
      test::draw_pairs(camera, test::extent_of(floor.world), {{0.45, 0.55}}, stream).front();
  const auto features_of = [&](const View& view) {
    return on_floor(FeatureExtractor().extract(renderer.render(view)), camera, view.altitude_m);
  };
  const FloorFeatures from = features_of(pair.a);
  const FloorFeatures to = features_of(pair.b);
  const double metres_per_pixel =
      std::min(pair.a.altitude_m, pair.b.altitude_m) / camera.model().fx;
  const RegistrationOptions options = registration_options_for(clean, settings);
  std::vector<double> ours_ms;
  std::vector<double> opencv_ms;
  for (std::size_t i = 0; i < kRepeats; ++i) {
    const Answer own = ours(from, to, options, i, false);
    const Answer other = opencv(from, to, options, metres_per_pixel);
    ours_ms.push_back(own.match_ms + own.solve_ms);
    opencv_ms.push_back(other.match_ms + other.solve_ms);
  }
  return {from.size(), to.size(), kRepeats, percentile(ours_ms, 0.5), percentile(opencv_ms, 0.5)};
}

}  // namespace fathom::benchmarks

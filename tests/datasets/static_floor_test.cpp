// No simulated floor keeps its content in place, whatever water, lamp and sensor do to the
// pictures.

#include <gtest/gtest.h>

#include "fathom/vision/static_view.hpp"
#include "src/datasets/simulated/simulated_survey.hpp"

namespace fathom {
namespace {

class StaticFloor : public ::testing::TestWithParam<FloorKind> {};

INSTANTIATE_TEST_SUITE_P(Simulated, StaticFloor,
                         ::testing::Values(FloorKind::mixed, FloorKind::ripples, FloorKind::mud,
                                           FloorKind::pebbles, FloorKind::patches));

TEST_P(StaticFloor, HasNothingThatStays) {
  SimulatedSurveyOptions options;
  options.world.floor = GetParam();
  options.world.metres_per_pixel = 0.01;
  options.mission.legs = 3;
  options.mission.leg_length_m = 8.0;
  options.camera.base.width = 320;
  options.camera.base.height = 240;
  options.camera.base.fx = options.camera.base.fy = 250.0;
  options.effects.water.caustics = 0.2;
  options.effects.camera.corner_light = 0.5;
  options.effects.camera.noise_sigma = 3.0;
  const SimulatedSurvey survey(options, 4);
  std::vector<cv::Mat> details;
  for (std::size_t i = 0; i < 16; ++i) {
    details.push_back(detail_of_view(survey.image((2 * i + 1) * survey.size() / 32)));
  }
  const StaticView view = find_static_view(details, {320, 240});
  EXPECT_TRUE(view.is_told);
  EXPECT_TRUE(view.mask.empty());
}

}  // namespace
}  // namespace fathom

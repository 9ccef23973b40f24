// What surveys of a study differ in, and what the trials of one share.

#include <memory>
#include <string>

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

#include "configuration/configured.hpp"
#include "fathom/core/random.hpp"
#include "fathom/harness/recording.hpp"
#include "front_end/map_cache.hpp"
#include "harness/small_config.hpp"
#include "src/datasets/simulated/simulated_survey.hpp"

namespace fathom {
namespace {

using test::configured;
using test::kSmallSurvey;

constexpr const char* kSea = R"(
dataset.world.relief_m: 0.02
dataset.attitude: {roll_sigma_rad: 0.02, pitch_sigma_rad: 0.02}
dataset.camera_effects.noise_sigma: 3
)";

bool same(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

struct Opened {
  std::unique_ptr<const DataSet> data;
  const SimulatedSurvey& survey;
};

Opened opened(const Configuration& configuration, std::size_t survey) {
  auto data = open_data_set(configuration, survey);
  const auto& frames = dynamic_cast<const SimulatedSurvey&>(*data->frames());
  return {std::move(data), frames};
}

// With the seed itself, not one derived from it: a study of one survey is a single run's.
TEST(SurveyDraws, SurveyZeroIsThatOfTheSeed) {
  const Configuration configuration = configured(std::string(kSmallSurvey) + kSea + "seed: 7\n");
  const Opened zero = opened(configuration, 0);
  const SimulatedSurvey alone(options_of<SimulatedSurveyOptions>(configuration.dataset.values), 7);
  EXPECT_EQ(zero.survey.info(3).altitude_m, alone.info(3).altitude_m);
  EXPECT_EQ(zero.survey.picture_id(3), alone.picture_id(3));
  EXPECT_TRUE(same(zero.survey.image(3), alone.image(3)));
}

TEST(SurveyDraws, SurveysDifferInAllThatIsDrawnOnce) {
  const Configuration configuration = configured(std::string(kSmallSurvey) + kSea);
  const Opened a = opened(configuration, 1);
  const Opened b = opened(configuration, 2);
  for (std::size_t i = 0; i < a.survey.size(); i += 8) {
    EXPECT_NE(a.survey.info(i).altitude_m, b.survey.info(i).altitude_m);
    EXPECT_NE(a.survey.true_tilt(i).roll_rad, b.survey.true_tilt(i).roll_rad);
    EXPECT_NE(a.survey.true_tilt(i).pitch_rad, b.survey.true_tilt(i).pitch_rad);
    EXPECT_NE(a.survey.picture_id(i), b.survey.picture_id(i));
    // The mission is the same.
    EXPECT_EQ(a.survey.info(i).ground_truth, b.survey.info(i).ground_truth);
    EXPECT_EQ(a.survey.true_altitude_m(i), b.survey.true_altitude_m(i));
  }
  EXPECT_FALSE(same(a.survey.world().picture, b.survey.world().picture));
  EXPECT_FALSE(same(a.survey.image(0), b.survey.image(0)));
  EXPECT_NE(a.survey.world().relief.at({0.3, 0.4}), b.survey.world().relief.at({0.3, 0.4}));
}

TEST(SurveyDraws, OpenedAgainASurveyIsTheSame) {
  const Configuration configuration = configured(std::string(kSmallSurvey) + kSea);
  const Opened a = opened(configuration, 1);
  const Opened again = opened(configuration, 1);
  EXPECT_EQ(a.survey.info(5).altitude_m, again.survey.info(5).altitude_m);
  EXPECT_TRUE(same(a.survey.image(5), again.survey.image(5)));
}

TEST(SurveyDraws, TrialsShareAltitudesAndPicturesAndDrawDeadReckoning) {
  const Configuration configuration = configured(std::string(kSmallSurvey) + kSea);
  const Recorder recorder(configuration, nullptr, 3);
  const auto trial = [&](std::uint64_t number) {
    return recorder.record(configuration, configuration.reference, builtin_estimators(),
                           {survey_seed(1, 3), number});
  };
  const Recording first = trial(0);
  const Recording second = trial(1);
  EXPECT_EQ(first.frame_stances, second.frame_stances);
  EXPECT_EQ(first.frame_stances[4], recorder.pictures()->info(4).stance());
  EXPECT_NE(first.frame_dead_reckoning, second.frame_dead_reckoning);
  const Recorder other(configuration, nullptr, 4);
  const Recording elsewhere = other.record(configuration, configuration.reference,
                                           builtin_estimators(), {survey_seed(1, 4), 0});
  EXPECT_NE(first.frame_stances, elsewhere.frame_stances);
  EXPECT_NE(first.frame_dead_reckoning, elsewhere.frame_dead_reckoning);
}

// The altimeter has noise and trials have visual odometry: still each pair once a survey. No loops.
TEST(SurveyDraws, APairIsRegisteredOnceASurvey) {
  Settings settings = test::settings_of(std::string(kSmallSurvey) + test::kVisualOdometry);
  settings.put(parse_override("front_end.candidates.max_distance_m=0.001"));
  const Configuration configuration = configure(settings, test::kSingle, builtin_estimators());
  ASSERT_GT(
      options_of<SimulatedSurveyOptions>(configuration.dataset.values).altitude.altimeter_sigma_m,
      0.0);
  test::MapCache cache;
  const auto record = [&](std::size_t survey, std::uint64_t trial) {
    Recorder(configuration, &cache, survey)
        .record(configuration, configuration.reference, builtin_estimators(),
                {survey_seed(1, survey), trial});
    return cache.size();
  };
  const std::size_t of_one_survey = record(0, 0);
  EXPECT_GE(of_one_survey, 32u);  // 33 frames
  EXPECT_EQ(record(0, 1), of_one_survey);
  EXPECT_EQ(record(1, 0), 2 * of_one_survey);
  EXPECT_EQ(record(1, 1), 2 * of_one_survey);
}

}  // namespace
}  // namespace fathom

#include "fathom/front_end/calibration.hpp"

#include <algorithm>
#include <numbers>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "front_end/turning_survey.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

constexpr std::uint64_t kSeeds = 20;

// Of normal errors one in 370 is beyond three standard deviations.
class WithinThreeSigmas {
 public:
  void add(const Estimated& one, double truth) {
    ++count_;
    if (std::abs(one.value - truth) > 3.0 * one.sigma) ++beyond_;
    worst_ = std::max(worst_, std::abs(one.value - truth) / one.sigma);
    squares_ += std::pow((one.value - truth) / one.sigma, 2);
  }
  void expect() const {
    EXPECT_LE(beyond_, 1) << worst_;
    EXPECT_LT(worst_, 4.5);
    // Nor are standard deviations much too large.
    EXPECT_GT(squares_ / count_, 0.3);
  }

 private:
  int count_ = 0;
  int beyond_ = 0;
  double worst_ = 0.0;
  double squares_ = 0.0;
};

TEST(Calibration, FindsMountingClockAndScaleWithinTheirSigmas) {
  TurningSurvey survey;
  survey.mount = {0.2, -0.1, 0.3};
  survey.scale = 1.04;
  survey.clock_late_s = 0.37;
  WithinThreeSigmas scale;
  WithinThreeSigmas yaw;
  WithinThreeSigmas x;
  WithinThreeSigmas y;
  WithinThreeSigmas clock;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Calibration found = calibrate(survey.input(seed));
    ASSERT_TRUE(found.set_up);
    scale.add(found.set_up->scale, 1.04);
    yaw.add(found.set_up->yaw_rad, 0.3);
    x.add(found.set_up->lever_x_m, 0.2);
    y.add(found.set_up->lever_y_m, -0.1);
    clock.add(found.set_up->time_offset_s, -0.37);
    EXPECT_THAT(found.findings,
                ElementsAre(AllOf(HasSubstr("the camera is turned"), HasSubstr("mounting: {x: 0.")),
                            HasSubstr("'scale: 0.9"), HasSubstr("time_offset_s: -0.3")));
  }
  for (const WithinThreeSigmas* one : {&scale, &yaw, &x, &y, &clock}) one->expect();
}

// Without noise the estimate is the truth: all derivatives lead there.
TEST(Calibration, IsExactWithoutNoise) {
  TurningSurvey survey;
  survey.mount = {0.4, 0.15, -2.8};
  survey.scale = 0.9;
  survey.noise_m = survey.noise_rad = survey.registration_noise_m = 0.0;
  const Calibration found = calibrate(survey.input(1));
  ASSERT_TRUE(found.set_up);
  EXPECT_NEAR(found.set_up->scale.value, 0.9, 1e-5);
  EXPECT_NEAR(found.set_up->yaw_rad.value, -2.8, 1e-5);
  EXPECT_NEAR(found.set_up->lever_x_m.value, 0.4, 1e-4);
  EXPECT_NEAR(found.set_up->lever_y_m.value, 0.15, 1e-4);
  EXPECT_NEAR(found.set_up->time_offset_s.value, 0.0, 1e-5);
}

TEST(Calibration, FindsNothingWhereNothingIsWrong) {
  const TurningSurvey survey;
  for (std::uint64_t seed = 0; seed < 50; ++seed) {
    EXPECT_THAT(calibrate(survey.input(seed)).findings, IsEmpty()) << seed;
  }
}

// Noise of what is regressed on makes it longer than it is: by 5 % here, and 20 % in shorter
// motions.
TEST(Calibration, TheNoiseOfRegistrationsIsNoScale) {
  for (const auto& [noise_m, interval_s] :
       {std::pair{0.02, 0.5}, std::pair{0.04, 0.5}, std::pair{0.04, 0.25}}) {
    TurningSurvey survey;
    survey.registration_noise_m = noise_m;
    survey.picture_interval_s = interval_s;
    double sum = 0.0;
    for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
      const Calibration found = calibrate(survey.input(seed));
      ASSERT_TRUE(found.set_up);
      sum += found.set_up->scale.value;
      EXPECT_LT(std::abs(found.set_up->scale.value - 1.0), 3.0 * found.set_up->scale.sigma);
      EXPECT_THAT(found.findings, IsEmpty()) << seed;
    }
    EXPECT_NEAR(sum / kSeeds, 1.0, 0.015) << noise_m << " m, " << interval_s << " s";
  }
}

TEST(Calibration, RegistrationsOfNoiseAloneTellNoScale) {
  TurningSurvey survey;
  survey.registration_noise_m = 0.2;
  const Calibration found = calibrate(survey.input(10));
  ASSERT_TRUE(found.set_up);
  EXPECT_GT(found.set_up->scale.sigma, 0.3 * found.set_up->scale.value);
  EXPECT_THAT(found.findings, Not(Contains(HasSubstr("times as long"))));
}

// Between two rows noise is averaged: an offset of half a step must not be taken for that.
TEST(Calibration, NoiseThatInterpolationAveragesIsNoClock) {
  TurningSurvey survey;
  survey.odometry_interval_s = 0.5;
  survey.noise_m = 0.03;
  survey.turning_rad = 0.4;
  survey.speed_change = 0.2;
  survey.noise_rad = 0.03;
  for (std::uint64_t seed = 0; seed < kSeeds; ++seed) {
    const Calibration found = calibrate(survey.input(seed));
    ASSERT_TRUE(found.set_up);
    EXPECT_LT(std::abs(found.set_up->time_offset_s.value), 4.0 * found.set_up->time_offset_s.sigma);
    EXPECT_THAT(found.findings, IsEmpty()) << seed;
  }
}

TEST(Calibration, ATenthOfWrongRegistrationsChangesNothing) {
  TurningSurvey survey;
  survey.mount.theta = std::numbers::pi / 2.0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    CalibrationInput input = survey.input(seed);
    RandomStream stream(seed, "wrong");
    for (std::size_t i = 0; i < input.motions.size(); i += 10) {
      input.motions[i].camera = {stream.normal(), stream.normal(), stream.normal()};
    }
    const Calibration found = calibrate(input);
    ASSERT_TRUE(found.set_up);
    EXPECT_LT(std::abs(found.set_up->yaw_rad.value - survey.mount.theta),
              4.0 * found.set_up->yaw_rad.sigma);
    EXPECT_LT(found.set_up->yaw_rad.sigma, 0.01);
  }
}

TEST(Calibration, NamesPicturesInReverseOrder) {
  const TurningSurvey survey;
  CalibrationInput input = survey.input(6);
  const std::size_t last = survey.pictures - 1;
  std::vector<SeenMotion> motions;
  for (auto motion = input.motions.rbegin(); motion != input.motions.rend(); ++motion) {
    const std::size_t from = last - motion->to;
    const std::size_t to = last - motion->from;
    motions.push_back(
        {from, to, input.frame_times_ns[from], input.frame_times_ns[to], inverse(motion->camera)});
  }
  input.motions = motions;
  EXPECT_THAT(calibrate(input).findings, ElementsAre(HasSubstr("in reverse order")));
}

TEST(Calibration, NamesTheTimeAtWhichAnAltimeterSteps) {
  const TurningSurvey survey;
  CalibrationInput input = survey.input(7);
  for (std::size_t i = 60; i < input.altitudes_m.size(); ++i) input.altitudes_m[i] *= 1.3;
  for (SeenMotion& motion : input.motions) {
    if (motion.from < 60) continue;
    motion.camera.x *= 1.3;
    motion.camera.y *= 1.3;
  }
  std::erase_if(input.motions, [](const SeenMotion& motion) { return motion.to == 60; });
  const Calibration found = calibrate(input);
  ASSERT_TRUE(found.set_up && found.set_up->step);
  EXPECT_NEAR(found.set_up->step->factor.value, 1.3, 4.0 * found.set_up->step->factor.sigma);
  EXPECT_NEAR(1e-9 * static_cast<double>(found.set_up->step->time_ns), 30.0, 1.01);
  EXPECT_THAT(found.findings, ElementsAre(AllOf(HasSubstr("altimeter0 steps there, by 1.3"),
                                                HasSubstr("s after the first picture"))));
}

TEST(Calibration, AStraightLegTellsNoLeverArmAndAnEvenOneNoClock) {
  TurningSurvey survey;
  survey.turning_rad = 0.0;
  survey.speed_change = 0.0;
  survey.mount = {0.5, 0.5, 0.0};
  const Calibration found = calibrate(survey.input(8));
  EXPECT_THAT(found.findings, IsEmpty());
  EXPECT_THAT(found.untold, ElementsAre(HasSubstr("where the camera is mounted"),
                                        HasSubstr("dead reckoning's clock"),
                                        HasSubstr("the scale of dead reckoning itself")));
}

// Each spike makes motions too long, some seconds before and after odometry has them so.
TEST(Calibration, AltitudesThatContradictOneAnotherTellNoClock) {
  TurningSurvey survey;
  survey.clock_late_s = 0.37;
  CalibrationInput input = survey.input(8);
  ASSERT_THAT(calibrate(input).findings, ElementsAre(HasSubstr("time_offset_s: -0.3")));
  for (std::size_t i = 5; i < input.altitudes_m.size(); i += 20) input.altitudes_m[i] *= 25.0;
  const Calibration found = calibrate(input);
  EXPECT_THAT(found.findings, IsEmpty());
  EXPECT_THAT(found.untold, Contains("dead reckoning's clock: altitudes contradict one another"));
  EXPECT_THAT(facts_of(found), Not(Contains(HasSubstr("clock"))));
}

TEST(Calibration, SaysThatOdometryIsOfAnotherSurvey) {
  CalibrationInput input = TurningSurvey().input(9);
  RandomStream stream(2, "other");
  for (SeenMotion& motion : input.motions) {
    motion.camera = {0.2 * stream.normal(), 0.2 * stream.normal(), 0.2 * stream.normal()};
  }
  EXPECT_THAT(calibrate(input).findings, ElementsAre(HasSubstr("nothing to do with")));
}

TEST(Calibration, APrincipalPointFarOffIsThatOfPicturesOfAnotherSize) {
  CalibrationInput input;
  input.camera.width = 320;
  input.camera.height = 240;
  EXPECT_THAT(calibrate(input).findings,
              ElementsAre(AllOf(HasSubstr("not the calibration's"), HasSubstr("2.00 times"))));
}

TEST(Calibration, OfNothingSaysNothing) {
  EXPECT_THAT(calibrate({}).findings, IsEmpty());
  CalibrationInput few = TurningSurvey().input(12);
  few.motions.resize(5);
  EXPECT_FALSE(calibrate(few).set_up);
  few.odometry.rows.clear();
  EXPECT_THAT(calibrate(few).findings, IsEmpty());
}

}  // namespace
}  // namespace fathom::test

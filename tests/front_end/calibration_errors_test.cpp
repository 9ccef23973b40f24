// What is no fault of the set-up, and what is a fault of a sensor's numbers.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/front_end/calibration.hpp"
#include "front_end/turning_survey.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

// Rolls of a vehicle that nobody measured move what registrations see: motions of 0.25 m by 0.1 m
// here, of which their covariances know 0.002 m.
TEST(Calibration, ErrorsThatRegistrationsDoNotTellAreNoScale) {
  TurningSurvey survey;
  survey.registration_noise_m = 0.1;
  for (const double scale : {1.0, 1.4}) {
    survey.scale = scale;
    for (std::uint64_t seed = 0; seed < 10; ++seed) {
      CalibrationInput input = survey.input(seed);
      for (SeenMotion& motion : input.motions) motion.variance_m2 = 2.0 * 0.002 * 0.002;
      const Calibration found = calibrate(input);
      const auto of_scale = Contains(HasSubstr("times as long as dead reckoning"));
      if (scale == 1.0) {
        EXPECT_THAT(found.findings, ::testing::Not(of_scale)) << seed;
        EXPECT_THAT(found.untold, Contains(HasSubstr("the scale: errors of registrations")))
            << seed;
      } else {
        EXPECT_THAT(found.findings, of_scale) << seed;
      }
    }
  }
}

TEST(Calibration, NamesOdometryThatHasNoHeadings) {
  CalibrationInput input = TurningSurvey().input(11);
  for (ReckonedRow& row : input.odometry.rows) row.heading_rad = 0.0;
  EXPECT_THAT(calibrate(input).findings,
              ElementsAre(HasSubstr("odometry0 has heading 0 rad in each of its ")));
  TurningSurvey straight;
  straight.turning_rad = 0.0;
  straight.noise_rad = 0.0;
  EXPECT_THAT(calibrate(straight.input(11)).findings, IsEmpty());
}

TEST(Calibration, NamesAUnitOfFixesAndOfGroundTruth) {
  const TurningSurvey survey;
  const auto with = [&](double of_fixes, double of_truth) {
    CalibrationInput input = survey.input(11);
    RandomStream stream(1, "fixes");
    for (double t = 0.0; t < 74.0; t += 1.0) {
      Pose truth = survey.truth(t);
      const std::int64_t time_ns = TurningSurvey::nanoseconds(t);
      const Eigen::Vector2d noise = 0.05 * Eigen::Vector2d(stream.normal(), stream.normal());
      input.readings.fixes.push_back({time_ns, of_fixes * (truth.position() + noise),
                                      0.0025 * of_fixes * of_fixes * Eigen::Matrix2d::Identity()});
      truth.x *= of_truth;
      truth.y *= of_truth;
      input.references.push_back({time_ns, truth});
    }
    return calibrate(input).findings;
  };
  EXPECT_THAT(with(1.0, 1.0), IsEmpty());
  EXPECT_THAT(with(1000.0, 1.0), ElementsAre(HasSubstr("ways of position0 are ")));
  EXPECT_THAT(with(1.0, 1000.0), ElementsAre(HasSubstr("ways of ground truth are ")));
}

TEST(Calibration, NamesTimeStampsInMicroseconds) {
  CalibrationInput input = TurningSurvey().input(11);
  for (std::int64_t& time_ns : input.frame_times_ns) time_ns /= 1000;
  for (SeenMotion& motion : input.motions) {
    motion.from_ns /= 1000;
    motion.to_ns /= 1000;
  }
  EXPECT_THAT(
      calibrate(input).findings,
      ElementsAre(HasSubstr("pictures are 0.0005 s apart in the mean; are the time stamps")));
}

TEST(Calibration, NamesVariancesOfOdometryOfAnotherUnit) {
  const auto with = [](double of_metres, double of_radians) {
    CalibrationInput input = TurningSurvey().input(11);
    for (SeenMotion& motion : input.motions) {
      motion.reckoned_variance_m2 *= of_metres;
      motion.reckoned_variance_rad2 *= of_radians;
    }
    return calibrate(input).findings;
  };
  for (const double careful : {0.02, 1.0, 100.0}) {
    EXPECT_THAT(with(careful, careful), IsEmpty()) << careful;
  }
  EXPECT_THAT(with(1e-6, 1.0),
              ElementsAre(AllOf(HasSubstr("variances of odometry0 are too small: a motion has σ "),
                                HasSubstr("step_var_x and step_var_y"))));
  EXPECT_THAT(with(1.0, 1e6),
              ElementsAre(AllOf(HasSubstr("too large"), HasSubstr("step_var_theta"))));
  EXPECT_THAT(with(0.0, 0.0), IsEmpty());
}

// Its headings are as they were.
TEST(Calibration, NamesAPathOfGroundTruthThatIsMirrored) {
  for (const double sign : {1.0, -1.0}) {
    CalibrationInput input = TurningSurvey().input(11);
    for (double t = 0.0; t < 74.0; t += 0.5) {
      Pose truth = TurningSurvey().truth(t);
      truth.y *= sign;
      input.references.push_back({TurningSurvey::nanoseconds(t), truth});
    }
    const std::vector<std::string> findings = calibrate(input).findings;
    if (sign > 0.0) {
      EXPECT_THAT(findings, IsEmpty());
    } else {
      EXPECT_THAT(findings, ElementsAre(HasSubstr("ground truth contradicts itself: its path ")));
    }
  }
}

TEST(Calibration, NamesGroundTruthThatHasNoHeadings) {
  CalibrationInput input = TurningSurvey().input(11);
  for (double t = 0.0; t < 74.0; t += 0.5) {
    Pose truth = TurningSurvey().truth(t);
    truth.theta = 0.0;
    input.references.push_back({TurningSurvey::nanoseconds(t), truth});
  }
  EXPECT_THAT(calibrate(input).findings,
              ElementsAre(HasSubstr("ground truth has heading 0 rad in each of its 148 poses")));
}

// Of a way that is the same from its end, registrations fit both.
TEST(Calibration, GroundTruthTellsMirroredOdometryFromAReverseOrder) {
  TurningSurvey survey;
  survey.even_about_s = 37.25;
  survey.speed_change = 0.0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    CalibrationInput input = survey.input(seed);
    for (ReckonedRow& row : input.odometry.rows) {
      row.y_m = -row.y_m;
      row.heading_rad = -row.heading_rad;
    }
    for (const std::int64_t time_ns : input.frame_times_ns) {
      input.references.push_back({time_ns, survey.truth(1e-9 * static_cast<double>(time_ns))});
    }
    EXPECT_THAT(calibrate(input).findings,
                ElementsAre(AllOf(HasSubstr("odometry0 has y to starboard"),
                                  HasSubstr("as ground truth shows"))))
        << seed;
  }
}

TEST(Calibration, GroundTruthTellsMirroredPicturesFromAReverseOrder) {
  TurningSurvey survey;
  survey.even_about_s = 37.25;
  survey.speed_change = 0.0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    CalibrationInput input = survey.input(seed);
    mirror_pictures(input);
    for (const std::int64_t time_ns : input.frame_times_ns) {
      input.references.push_back({time_ns, survey.truth(1e-9 * static_cast<double>(time_ns))});
    }
    EXPECT_THAT(calibrate(input).findings, ElementsAre(HasSubstr("the pictures are mirrored")))
        << seed;
  }
}

}  // namespace
}  // namespace fathom::test

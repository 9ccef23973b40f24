#include "fathom/front_end/visual_odometry.hpp"

#include <cmath>
#include <numbers>

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

#include "fathom/front_end/pair_seed.hpp"
#include "front_end/floor_survey.hpp"
#include "front_end/measured_frames.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::bend;
using test::FloorSurvey;
using test::kSeed;

Eigen::Matrix3d noise_covariance() {
  Eigen::Matrix3d C;
  C << 4e-4, 1e-4, -5e-5,  //
      1e-4, 2e-4, 3e-5,    //
      -5e-5, 3e-5, 1e-4;
  return C;
}

struct Odometry {
  explicit Odometry(const FloorSurvey& survey, const AddedNoise& noise = {},
                    std::uint64_t seed = kSeed, const FrontEndOptions& options = {})
      : registrar(survey, options.features, options.registration, seed),
        frames(survey, registrar, options.visual_odometry, noise) {}

  std::vector<UncertainPose> motions() const {
    std::vector<UncertainPose> all;
    for (std::size_t i = 1; i < frames.size(); ++i) all.push_back(*frames.info(i).motion);
    return all;
  }

  PairRegistrar registrar;
  VisualOdometry frames;
};

TEST(VisualOdometry, MeasuresTheTrueMotions) {
  const FloorSurvey survey(bend(6));
  const Odometry odometry(survey);
  const auto motions = odometry.motions();
  for (std::size_t i = 1; i < 6; ++i) {
    const Pose truth = between(survey.truth(i - 1), survey.truth(i));
    EXPECT_LT(test::distance(motions[i - 1].mean, truth), 0.006) << i;
  }
  EXPECT_EQ(odometry.frames.failures(), 0u);
}

TEST(VisualOdometry, IsTheRegistrationOfConsecutiveFrames) {
  const FloorSurvey survey(bend(3));
  const Odometry odometry(survey);
  const auto motions = odometry.motions();
  for (std::size_t i = 1; i < 3; ++i) {
    const auto seen = [&](std::size_t frame) {
      return on_floor(FeatureExtractor().extract(survey.image(frame)), survey.camera(),
                      test::kAltitudeM);
    };
    const Registration expected =
        register_pair(seen(i - 1), seen(i), {}, pair_seed(kSeed, i - 1, i));
    EXPECT_EQ(motions[i - 1].mean, expected.motion);
    EXPECT_EQ(motions[i - 1].covariance, expected.covariance);
    EXPECT_EQ(*odometry.frames.info(i).motion_errors, expected.shared);
  }
  EXPECT_EQ(odometry.frames.info(0).motion_errors, nullptr);
}

TEST(VisualOdometry, LeavesTheRestOfAFrameAsItIs) {
  FloorSurvey survey(bend(3));
  // What the source says of the motions is not what it is asked for.
  survey.add_odometry(Eigen::Matrix3d::Identity());
  const Odometry odometry(survey);
  EXPECT_TRUE(odometry.frames.has_odometry());
  EXPECT_TRUE(odometry.frames.has_ground_truth());
  EXPECT_EQ(odometry.frames.size(), 3u);
  EXPECT_FALSE(odometry.frames.info(0).motion);
  const FrameInfo& last = odometry.frames.info(2);
  EXPECT_EQ(last.time_ns, survey.info(2).time_ns);
  EXPECT_EQ(last.altitude_m, survey.info(2).altitude_m);
  EXPECT_EQ(last.ground_truth, survey.info(2).ground_truth);
  EXPECT_LT(last.motion->covariance.diagonal().maxCoeff(), 0.01);
}

TEST(VisualOdometry, WhatItSaidOfAFrameStaysWhereItIs) {
  constexpr std::size_t kFrames = 9;
  const FloorSurvey survey(bend(kFrames));
  const Odometry odometry(survey);
  std::vector<const FrameInfo*> said;
  for (std::size_t i = 0; i < kFrames; ++i) said.push_back(&odometry.frames.info(i));
  for (std::size_t i = 0; i < kFrames; ++i) EXPECT_EQ(&odometry.frames.info(i), said[i]) << i;
}

TEST(VisualOdometry, AddedNoiseAddsItsCovariance) {
  const FloorSurvey survey(bend(5));
  const auto plain = Odometry(survey).motions();
  const auto noisy = Odometry(survey, {noise_covariance(), 1, 0}).motions();
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const Eigen::Matrix3d added = noisy[i].covariance - plain[i].covariance;
    EXPECT_LT((added - noise_covariance()).cwiseAbs().maxCoeff(), 1e-18) << i;
    EXPECT_NE(noisy[i].mean, plain[i].mean) << i;
  }
}

TEST(VisualOdometry, TheFallbackScalesWithTheAltitude) {
  FloorSurvey survey(bend(4));
  survey.make_blank(2);
  FrontEndOptions options;
  options.visual_odometry.sigma_altitudes = 0.2;
  const auto motions = Odometry(survey, {}, kSeed, options).motions();
  const double sigma_m = 0.2 * test::kAltitudeM;
  EXPECT_NEAR(motions[1].covariance(0, 0), sigma_m * sigma_m, 1e-15);
}

TEST(VisualOdometry, RepeatsTheLastMotionWherePicturesDoNotRegister) {
  FloorSurvey survey(bend(6));
  survey.make_blank(2);
  FrontEndOptions options;
  options.visual_odometry = {.sigma_m = 0.5, .sigma_rad = 0.25};
  const Odometry odometry(survey, {}, kSeed, options);
  const auto motions = odometry.motions();
  const Eigen::Matrix3d fallback = Eigen::Vector3d(0.25, 0.25, 0.0625).asDiagonal();
  for (const std::size_t failed : {1u, 2u}) {
    EXPECT_EQ(motions[failed].mean, motions[0].mean);
    EXPECT_EQ(motions[failed].covariance, fallback);
    EXPECT_EQ(odometry.frames.info(failed + 1).motion_errors, nullptr);
  }
  EXPECT_LT(test::distance(motions[3].mean, between(survey.truth(3), survey.truth(4))), 0.006);
  EXPECT_EQ(odometry.frames.failures(), 2u);
}

TEST(VisualOdometry, RepeatsWhatWasMeasuredNotItsNoise) {
  FloorSurvey survey(bend(4));
  for (const std::size_t blank : {2u, 3u}) survey.make_blank(blank);
  const AddedNoise noise{noise_covariance(), 3, 0};
  const auto plain = Odometry(survey).motions();
  const auto noisy = Odometry(survey, noise).motions();
  // The draws are those of the stream, in the order of the frames.
  RandomStream stream(noise.seed, "visual_odometry", noise.trial);
  const MotionNoise draws(noise.covariance);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    const Eigen::Vector3d expected = plain[i].mean.vector() + draws.draw(stream);
    EXPECT_LT((noisy[i].mean.vector() - expected).norm(), 1e-15) << i;
  }
}

TEST(VisualOdometry, WithoutAnyMatchStandsStill) {
  FloorSurvey survey(bend(3));
  for (std::size_t i = 0; i < 3; ++i) survey.make_blank(i);
  const Odometry odometry(survey);
  for (const UncertainPose& motion : odometry.motions()) {
    EXPECT_EQ(motion.mean, Pose{});
    EXPECT_TRUE(is_positive_definite(motion.covariance));
  }
  EXPECT_EQ(odometry.frames.failures(), 2u);
}

// Blank pictures stand still, so that what comes out is the noise alone.
std::vector<UncertainPose> noise_alone(std::size_t frames, const Eigen::Matrix3d& covariance) {
  CameraModel tiny;
  tiny.width = tiny.height = 16;
  tiny.fx = tiny.fy = 16.0;
  tiny.cx = tiny.cy = 7.5;
  FloorSurvey survey(std::vector<Pose>(frames), tiny);
  for (std::size_t i = 0; i < frames; ++i) survey.make_blank(i);
  return Odometry(survey, {covariance, 7, 0}).motions();
}

TEST(VisualOdometry, TheNoiseHasItsCovariance) {
  const auto motions = noise_alone(4001, noise_covariance());
  const auto count = static_cast<double>(motions.size());
  const Eigen::Matrix3d L = noise_covariance().llt().matrixL();
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  Eigen::Matrix3d second = Eigen::Matrix3d::Zero();
  for (const UncertainPose& motion : motions) {
    const Eigen::Vector3d white = L.triangularView<Eigen::Lower>().solve(motion.mean.vector());
    mean += white / count;
    second += white * white.transpose() / count;
  }
  // Five standard deviations of a mean, and of a variance, of that many draws.
  EXPECT_LT(mean.cwiseAbs().maxCoeff(), 5.0 / std::sqrt(count));
  EXPECT_LT((second - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff(),
            5.0 * std::sqrt(2.0 / count));
}

TEST(VisualOdometry, ANoisyHeadingIsWrapped) {
  const Eigen::Matrix3d wild = Eigen::Vector3d(1e-4, 1e-4, 9.0).asDiagonal();
  double largest = 0.0;
  for (const UncertainPose& motion : noise_alone(200, wild)) {
    EXPECT_LE(std::abs(motion.mean.theta), std::numbers::pi);
    largest = std::max(largest, std::abs(motion.mean.theta));
  }
  EXPECT_GT(largest, 2.0);
}

void expect_equal(const std::vector<UncertainPose>& a, const std::vector<UncertainPose>& b,
                  bool equal) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_EQ(a[i].mean == b[i].mean, equal) << i;
}

TEST(VisualOdometry, TheSeedsMakeTheMotions) {
  const FloorSurvey survey(bend(4));
  const AddedNoise noise{noise_covariance(), 3, 0};
  const auto motions = Odometry(survey, noise).motions();
  expect_equal(motions, Odometry(survey, noise).motions(), true);
  expect_equal(motions, Odometry(survey, {noise_covariance(), 4, 0}).motions(), false);
  expect_equal(motions, Odometry(survey, {noise_covariance(), 3, 1}).motions(), false);
}

TEST(VisualOdometry, AskingForALaterFrameFirstMakesNoDifference) {
  const FloorSurvey survey(bend(5));
  const AddedNoise noise{noise_covariance(), 3, 0};
  const Odometry in_order(survey, noise);
  const Odometry late(survey, noise);
  const auto motions = in_order.motions();
  EXPECT_EQ(late.frames.info(4).motion->mean, motions[3].mean);
  expect_equal(late.motions(), motions, true);
}

}  // namespace
}  // namespace fathom

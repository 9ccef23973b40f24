// EDGE_PRIOR_SE2 and EDGE_PRIOR_SE2_XY: what they mean, where the graph stands, where it starts.

#include <cmath>
#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/measurements/connected_guess.hpp"
#include "fathom/measurements/g2o.hpp"
#include "measurements/parsed_graph.hpp"
#include "support/input_error.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::parse;
using testing::AllOf;
using testing::HasSubstr;

const std::string kStep = "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n";
const std::string kPose = " 2 3 0.5 4 1 0 5 0 6\n";

TEST(G2oPrior, ArrivesWithItsKeyframe) {
  const MeasurementLog log =
      parse("EDGE_PRIOR_SE2 1 2 3 0.5 4 1 0.5 5 0.25 6\nEDGE_PRIOR_SE2_XY 0 7 8 3 1 2\n" + kStep);
  EXPECT_EQ(log.absolute_count(), 2U);
  const AbsolutePose& pose = log.arrival(1).absolute.at(0);
  EXPECT_EQ(pose.keyframe, 1U);
  EXPECT_EQ(pose.pose, (Pose{2, 3, 0.5}));
  Eigen::Matrix3d information;  // the upper triangle by rows
  information << 4, 1, 0.5, 1, 5, 0.25, 0.5, 0.25, 6;
  EXPECT_EQ(pose.information, information);
  const AbsolutePose& fix = log.arrival(0).absolute.at(0);
  EXPECT_EQ(fix.pose, (Pose{7, 8, 0}));
  information << 3, 1, 0, 1, 2, 0, 0, 0, 0;
  EXPECT_EQ(fix.information, information);
}

// By hand. A faces port, so its x axis is the world's y: X is 0.5 ahead and 0.2 to starboard.
TEST(G2oPrior, InformationIsInTheAxesOfThePrior) {
  const MeasurementLog log =
      parse("EDGE_PRIOR_SE2 0 1 1 1.5707963267948966 100 0 0 1 0 10\n" + kStep);
  const std::vector<Pose> at{{1.2, 1.5, 1.5707963267948966 + 0.1}, {1.2, 2.5, 0}};
  EXPECT_NEAR(chi2(log.arrival(0).absolute.at(0), at[0]), 100 * 0.25 + 1 * 0.04 + 10 * 0.01, 1e-12);
  // A fix is in world axes, whatever the heading.
  const MeasurementLog fixed = parse("EDGE_PRIOR_SE2_XY 0 1 1 100 0 1\nFIX 0\n" + kStep);
  EXPECT_NEAR(absolute_chi2(fixed, at), 100 * 0.04 + 1 * 0.25, 1e-12);
}

TEST(G2oPrior, HoldsTheGraphUnlessAVertexIsFixed) {
  const std::string prior = "EDGE_PRIOR_SE2 1" + kPose;
  EXPECT_TRUE(parse(prior + kStep).start().is_free);
  EXPECT_TRUE(parse(prior + kStep + "FIX 0\n").start().is_fixed());
  EXPECT_TRUE(parse(kStep).start().is_fixed());
  // One that says nothing holds nothing.
  EXPECT_TRUE(parse("EDGE_PRIOR_SE2 1 2 3 0.5 0 0 0 0 0 0\n" + kStep).start().is_fixed());
}

TEST(G2oPrior, ThoseThatLeaveTheGraphOpenAreRefused) {
  const std::string heading = "EDGE_PRIOR_SE2 0 0 0 0.5 0 0 0 0 0 6\n";
  EXPECT_THAT(
      input_error_of([&] { parse(heading + kStep); }),
      AllOf(HasSubstr("graph.g2o:1: "), HasSubstr("do not say the position"), HasSubstr("FIX 0")));
  const std::string fix = "EDGE_PRIOR_SE2_XY 1 2 3 4 0 5\n";
  EXPECT_THAT(input_error_of([&] { parse(fix + kStep); }), HasSubstr("do not say the heading"));
  EXPECT_TRUE(parse(heading + fix + kStep).start().is_free);
  // Two positions turn it; two of one pose do not.
  EXPECT_TRUE(parse(fix + "EDGE_PRIOR_SE2_XY 0 2 3 4 0 5\n" + kStep).start().is_free);
  EXPECT_THAT(input_error_of([&] { parse(fix + fix + kStep); }), HasSubstr("say the heading"));
  // Along one axis each, at two poses: two of three freedoms.
  EXPECT_THAT(input_error_of([&] {
                parse("EDGE_PRIOR_SE2_XY 0 2 3 4 0 0\nEDGE_PRIOR_SE2_XY 1 2 3 0 0 4\n" + kStep);
              }),
              HasSubstr("say the heading (or a direction"));
}

struct Bad {
  std::string text;
  std::string what;
};

TEST(G2oPrior, BadOnesAreRefusedWithTheirLine) {
  for (const Bad& bad : std::vector<Bad>{
           {"EDGE_PRIOR_SE2 0 1 2 3 1 0 0 1 0", "(10 values), got 9"},
           {"EDGE_PRIOR_SE2 0 1 2 3 1 0 0 1 0 1 1", "(10 values), got 11"},
           {"EDGE_PRIOR_SE2_XY 0 1 2 1 0", "(6 values), got 5"},
           {"EDGE_PRIOR_SE2_XY 0 1 2 1 0 nan", "'nan' is not a finite number"},
           {"EDGE_PRIOR_SE2 0.5 1 2 3 1 0 0 1 0 1", "'0.5' is not an id"},
           {"EDGE_PRIOR_SE2 0 1 2 3 1 0 0 1 0 -1", "negative eigenvalue"},
           {"EDGE_PRIOR_SE2 0 1 2 3 1 2 0 1 0 1", "negative eigenvalue"},
           {"EDGE_PRIOR_SE2 0 1 2 3 1 0 1 1 0 0", "negative eigenvalue"},
           {"EDGE_PRIOR_SE2_XY 0 1 2 1 1.001 1", "expected a positive semi-definite"},
           {"EDGE_PRIOR_SE2 9 1 2 3 1 0 0 1 0 1", "pose 9, of which the file has no edge"}}) {
    const std::string message = input_error_of([&] { parse(kStep + bad.text + "\n"); });
    EXPECT_THAT(message, AllOf(HasSubstr("graph.g2o:2: "), HasSubstr(bad.what))) << bad.text;
  }
  const std::string vertices = "VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 0\n";
  EXPECT_THAT(input_error_of([&] { parse(vertices + kStep + "EDGE_PRIOR_SE2_XY 9 1 2 1 0 1\n"); }),
              AllOf(HasSubstr("graph.g2o:4: "), HasSubstr("vertex 9, which the file does not")));
  // Singular is right.
  EXPECT_NO_THROW(parse(kStep + "FIX 0\nEDGE_PRIOR_SE2 0 1 2 3 1 1 0 1 0 0\n"));
}

// F of a log at random places, before and after its start was made known.
void expect_same_cost(const MeasurementLog& log, const MeasurementLog& started) {
  RandomStream random(5, "places");
  for (int i = 0; i < 10; ++i) {
    const std::vector<Pose> at{test::random_pose(random), test::random_pose(random)};
    EXPECT_NEAR(chi2(started, at), chi2(log, at), 1e-9 * chi2(log, at));
    EXPECT_NEAR(absolute_chi2(started, at), absolute_chi2(log, at), 1e-9 * chi2(log, at));
  }
  EXPECT_EQ(degrees_of_freedom(started), degrees_of_freedom(log));
}

TEST(G2oPrior, OneOfTheFirstPoseIsTheStart) {
  const MeasurementLog log = parse("EDGE_PRIOR_SE2 0" + kPose + kStep);
  const MeasurementLog started = with_start_of_priors(log, "graph.g2o");
  EXPECT_FALSE(started.start().is_free);
  EXPECT_EQ(started.absolute_count(), 0U);
  EXPECT_NEAR(started.origin().x, 2, 1e-15);
  EXPECT_NEAR(started.origin().theta, 0.5, 1e-15);
  EXPECT_TRUE(started.start().measurement().information.isApprox(
      log.arrival(0).absolute[0].information, 1e-12));
  expect_same_cost(log, started);
}

// A compass and a fix say three things of a pose, and nothing twice: both can be met. A second fix
// contradicts the first; F has what that costs, as it stays a measurement.
TEST(G2oPrior, AHeadingAndAFixAreTheStartTogether) {
  const std::string compass = "EDGE_PRIOR_SE2 0 9 9 -3 0 0 0 0 0 400\n";
  const std::string fix = "EDGE_PRIOR_SE2_XY 0 2 3 4 1 5\n";
  const std::string other = "EDGE_PRIOR_SE2_XY 0 2.5 3 4 0 5\n";
  const MeasurementLog log = parse(fix + other + compass + kStep);
  const MeasurementLog started = with_start_of_priors(log, "graph.g2o");
  ASSERT_EQ(started.absolute_count(), 1U);
  EXPECT_EQ(started.arrival(0).absolute[0].pose.x, 2.5);
  EXPECT_NEAR(started.origin().x, 2, 1e-12);
  EXPECT_NEAR(started.origin().y, 3, 1e-12);
  EXPECT_NEAR(started.origin().theta, -3, 1e-12);
  EXPECT_NEAR(started.start().covariance(2, 2), 1.0 / 400, 1e-15);
  expect_same_cost(log, started);
}

TEST(G2oPrior, AStartThatIsNotDeterminedSaysWhatIsMissing) {
  const std::string pose = "EDGE_PRIOR_SE2 1" + kPose;
  const auto refused = [&](const std::string& priors) {
    return input_error_of([&] { with_start_of_priors(parse(priors + pose + kStep), "graph.g2o"); });
  };
  EXPECT_THAT(refused("EDGE_PRIOR_SE2_XY 0 2 3 4 0 5\n"),
              AllOf(HasSubstr("graph.g2o: "), HasSubstr("its heading,"), HasSubstr("FIX 0")));
  EXPECT_THAT(refused("EDGE_PRIOR_SE2 0 2 3 1 0 0 0 0 0 5\n"), HasSubstr("its position,"));
  EXPECT_THAT(refused(""), HasSubstr("its position and heading,"));
  // A heading that may be any is none.
  EXPECT_THAT(refused("EDGE_PRIOR_SE2 0 2 3 1 4 0 0 4 0 0.01\n"), HasSubstr("its heading,"));
  // A fixed start stays.
  const MeasurementLog fixed = parse(pose + kStep + "FIX 0\n");
  EXPECT_TRUE(with_start_of_priors(fixed, "").start().is_fixed());
}

MeasurementLog random_log(const StartPose& start) {
  RandomStream random(3, "world");
  MeasurementLog log(start);
  for (std::size_t k = 0; k <= 20; ++k) {
    if (k > 0) {
      RelativePose step = RelativePose::from_covariance(k - 1, k, test::random_pose(random),
                                                        test::random_covariance(random, 1e-2));
      step.is_hole = k % 7 == 3;
      log.add_keyframe(step);
    }
    if (k > 4) {
      log.add_registration(RelativePose::from_covariance(k, k - 5, test::random_pose(random),
                                                         test::random_covariance(random, 1.0)));
    }
    if (k % 3 == 0) log.add_absolute(AbsolutePose::heading(k, 3.0 + 0.1 * random.normal(), 0.1));
    if (k % 4 == 1) {
      log.add_absolute(
          AbsolutePose::position(k, {1.0 / 3.0, random.normal()},
                                 test::random_covariance(random, 1.0).topLeftCorner<2, 2>()));
    }
    if (k % 5 == 0) {
      log.add_absolute(AbsolutePose::from_covariance(k, test::random_pose(random),
                                                     test::random_covariance(random, 1e3)));
    }
  }
  return log;
}

void expect_same_log(const MeasurementLog& a, const MeasurementLog& b) {
  EXPECT_EQ(a.start().pose, b.start().pose);
  EXPECT_EQ(a.start().covariance, b.start().covariance);
  EXPECT_EQ(a.start().is_free, b.start().is_free);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t k = 0; k < a.size(); ++k) {
    if (k > 0) {
      EXPECT_EQ(a.arrival(k).step.motion, b.arrival(k).step.motion);
      EXPECT_EQ(a.arrival(k).step.information, b.arrival(k).step.information);
      EXPECT_EQ(a.arrival(k).step.is_hole, b.arrival(k).step.is_hole);
    }
    ASSERT_EQ(a.arrival(k).absolute.size(), b.arrival(k).absolute.size());
    for (std::size_t i = 0; i < a.arrival(k).absolute.size(); ++i) {
      EXPECT_EQ(a.arrival(k).absolute[i].pose, b.arrival(k).absolute[i].pose);
      EXPECT_EQ(a.arrival(k).absolute[i].information, b.arrival(k).absolute[i].information);
    }
  }
}

TEST(G2oPrior, LogsAreReadBackToTheSameBits) {
  StartPose uncertain(Pose{1.0 / 3.0, -7, 3.1});
  RandomStream random(4, "start");
  uncertain.covariance = test::random_covariance(random, 0.1);
  StartPose free(Pose{1, 2, 0.1});
  free.is_free = true;
  for (const StartPose& start : {StartPose(Pose{1, 2, 3}), uncertain, free}) {
    const MeasurementLog log = random_log(start);
    const std::string text = to_g2o(log);
    const MeasurementLog again = parse(text);
    expect_same_log(again, log);
    EXPECT_EQ(to_g2o(again), text);
    EXPECT_EQ(text.find("FIX") != std::string::npos, start.is_fixed());
  }
}

// Who edits the numbers of a start has a prior as any other.
TEST(G2oPrior, AStartThatWasEditedIsAPrior) {
  StartPose start(Pose{1, 2, 0});
  start.covariance = Eigen::Vector3d(0.04, 0.04, 0.01).asDiagonal();
  MeasurementLog log(start);
  log.add_keyframe(RelativePose::from_covariance(0, 1, {1, 0, 0}, Eigen::Matrix3d::Identity()));
  std::string text = to_g2o(log);
  EXPECT_FALSE(parse(text).start().is_free);
  text.replace(text.find("EDGE_PRIOR_SE2 0 1 2 0 "), 23, "EDGE_PRIOR_SE2 0 1 2 0 1");
  EXPECT_TRUE(parse(text).start().is_free);
  EXPECT_EQ(parse(text).absolute_count(), 1U);
}

}  // namespace
}  // namespace fathom

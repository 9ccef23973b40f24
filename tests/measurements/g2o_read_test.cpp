#include <fstream>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/measurements/g2o.hpp"
#include "measurements/parsed_graph.hpp"
#include "support/planar.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::parse;
using testing::ElementsAre;

const std::string kInformation = " 100 1 2 200 3 300";

TEST(G2oRead, VerticesEdgesAndFix) {
  const MeasurementLog log = parse(
      "VERTEX_SE2 0 1 2 0.5\n"
      "FIX 0\n"
      "VERTEX_SE2 1 2 2 0.6\n"
      "EDGE_SE2 0 1 1 -0.5 0.1" +
      kInformation + "\n");
  EXPECT_EQ(log.size(), 2U);
  EXPECT_EQ(log.origin(), (Pose{1, 2, 0.5}));
  EXPECT_THAT(log.ids, ElementsAre(0, 1));
  ASSERT_TRUE(log.guess);
  EXPECT_THAT(*log.guess, ElementsAre(Pose{1, 2, 0.5}, Pose{2, 2, 0.6}));
  const RelativePose& step = log.arrival(1).step;
  EXPECT_EQ(step.motion, (Pose{1, -0.5, 0.1}));
  Eigen::Matrix3d information;
  information << 100, 1, 2, 1, 200, 3, 2, 3, 300;
  EXPECT_EQ(step.information, information);
  EXPECT_FALSE(step.inliers);
}

TEST(G2oRead, FilesWithoutVertices) {
  const MeasurementLog log = parse("EDGE_SE2 0 1 1 0 0" + kInformation + "\n");
  EXPECT_EQ(log.size(), 2U);
  EXPECT_EQ(log.origin(), Pose{});
  EXPECT_FALSE(log.guess);
}

TEST(G2oRead, ToroTokensAndTheirInformationOrder) {
  const MeasurementLog log = parse(
      "VERTEX2 0 0 0 0\n"
      "VERTEX2 1 1 0 0\n"
      "EDGE2 0 1 1 0 0 100 1 200 300 2 3\n");
  Eigen::Matrix3d information;  // xx xy yy tt xt yt
  information << 100, 1, 2, 1, 200, 3, 2, 3, 300;
  EXPECT_EQ(log.arrival(1).step.information, information);
}

TEST(G2oRead, CommentsBlankLinesCrlfTabsAndNoNewlineAtTheEnd) {
  const MeasurementLog log = parse(
      "# head\r\n\r\n"
      "  VERTEX_SE2\t0 0 0 0  # behind\r\n"
      "VERTEX_SE2 1 1 0 0\r\n"
      "FIX 0\r\n"
      "EDGE_SE2 0 1 +1.5 0 0" +
      kInformation);
  EXPECT_EQ(log.size(), 2U);
  EXPECT_EQ(log.arrival(1).step.motion.x, 1.5);
}

TEST(G2oRead, IdsWithGapsHugeAndOutOfOrder) {
  const MeasurementLog log =
      parse("EDGE_SE2 9223372036854775806 9223372036854775807 3 0 0" + kInformation +
            "\n"
            "EDGE_SE2 70 9223372036854775806 2 0 0" +
            kInformation +
            "\n"
            "EDGE_SE2 7 70 1 0 0" +
            kInformation + "\n");
  EXPECT_THAT(log.ids, ElementsAre(7, 70, 9223372036854775806LL, 9223372036854775807LL));
  for (std::size_t k = 1; k < 4; ++k) {
    EXPECT_EQ(log.arrival(k).step.motion.x, static_cast<double>(k));
  }
}

TEST(G2oRead, ReplayTakesTheFirstForwardEdgeAsTheStep) {
  // Between 0 and 1: backward, forward, forward again. The first forward one is the step, the
  // others are registrations in file order.
  const MeasurementLog log = parse("EDGE_SE2 1 0 -7 0 0" + kInformation +
                                   "\n"
                                   "EDGE_SE2 0 1 1 0 0" +
                                   kInformation +
                                   "\n"
                                   "EDGE_SE2 0 1 1.5 0 0" +
                                   kInformation + "\n");
  EXPECT_EQ(log.arrival(1).step.motion.x, 1);
  ASSERT_EQ(log.arrival(1).registrations.size(), 2U);
  EXPECT_EQ(log.arrival(1).registrations[0].motion.x, -7);
  EXPECT_EQ(log.arrival(1).registrations[0].from, 1U);
  EXPECT_EQ(log.arrival(1).registrations[1].motion.x, 1.5);
}

TEST(G2oRead, ABackwardEdgeIsTheStepWhereThereIsNoOther) {
  const MeasurementLog log = parse("EDGE_SE2 1 0 -1 0 0" + kInformation + "\n");
  EXPECT_EQ(log.arrival(1).step.from, 1U);
  EXPECT_NEAR(log.odometry()[1].x, 1.0, 1e-15);
}

TEST(G2oRead, RegistrationsArriveWithTheirLaterKeyframe) {
  // The loop to 3 stands first in the file; the backward one belongs to 2.
  const MeasurementLog log = parse("EDGE_SE2 0 3 3 0 0" + kInformation +
                                   "\n"
                                   "EDGE_SE2 0 1 1 0 0" +
                                   kInformation +
                                   "\n"
                                   "EDGE_SE2 2 0 -2 0 0" +
                                   kInformation +
                                   "\n"
                                   "EDGE_SE2 1 2 1 0 0" +
                                   kInformation +
                                   "\n"
                                   "EDGE_SE2 1 3 2 0 0" +
                                   kInformation +
                                   "\n"
                                   "EDGE_SE2 2 3 1 0 0" +
                                   kInformation + "\n");
  EXPECT_TRUE(log.arrival(1).registrations.empty());
  ASSERT_EQ(log.arrival(2).registrations.size(), 1U);
  EXPECT_EQ(log.arrival(2).registrations[0].from, 2U);  // as written, not turned
  ASSERT_EQ(log.arrival(3).registrations.size(), 2U);
  EXPECT_EQ(log.arrival(3).registrations[0].from, 0U);
  EXPECT_EQ(log.arrival(3).registrations[1].from, 1U);
}

TEST(G2oRead, HeadingsAreWrapped) {
  const MeasurementLog log = parse(
      "VERTEX_SE2 0 0 0 7\nVERTEX_SE2 1 0 0 -7\n"
      "EDGE_SE2 0 1 0 0 10" +
      kInformation + "\n");
  EXPECT_NEAR(log.origin().theta, 7 - 6.283185307179586, 1e-15);
  EXPECT_NEAR(log.arrival(1).step.motion.theta, 10 - 2 * 6.283185307179586, 1e-14);
}

TEST(G2oRead, OneVertexAlone) {
  const MeasurementLog log = parse("VERTEX_SE2 3 1 2 0\n");
  EXPECT_EQ(log.size(), 1U);
  EXPECT_EQ(log.origin(), (Pose{1, 2, 0}));
}

TEST(G2oRead, InliersStandAboveTheirEdge) {
  const MeasurementLog log = parse("EDGE_SE2 0 1 1 0 0" + kInformation +
                                   "\n"
                                   "# inliers 42\n"
                                   "EDGE_SE2 0 1 1 0 0" +
                                   kInformation +
                                   "\n"
                                   "# inliers none\n# inliers -3\n"
                                   "EDGE_SE2 0 1 1 0 0" +
                                   kInformation + "\n");
  EXPECT_FALSE(log.arrival(1).step.inliers);
  EXPECT_EQ(log.arrival(1).registrations[0].inliers, 42);
  EXPECT_FALSE(log.arrival(1).registrations[1].inliers);
}

TEST(G2oRead, WhatAnOwnCovarianceStandsForIsAboveItsEdge) {
  const std::string edge = "EDGE_SE2 0 1 1 0 0" + kInformation + "\n";
  const MeasurementLog log = parse(edge + "# repeats 3.5\n# inliers 42\n" + edge +
                                   "# repeats 0.2\n" + edge + "# repeats 3.5 own\n" + edge);
  EXPECT_EQ(log.arrival(1).registrations[0].repeats, 3.5);
  EXPECT_EQ(log.arrival(1).registrations[0].inliers, 42);
  EXPECT_EQ(log.arrival(1).registrations[1].repeats, 1.0);
  EXPECT_EQ(log.arrival(1).registrations[2].repeats, 1.0);
  EXPECT_EQ(parse(to_g2o(log)).arrival(1).registrations[0].repeats, 3.5);
}

void expect_same_bits(const RelativePose& a, const RelativePose& b) {
  EXPECT_EQ(a.from, b.from);
  EXPECT_EQ(a.to, b.to);
  EXPECT_EQ(a.motion, b.motion);
  EXPECT_EQ(a.information, b.information);
  EXPECT_EQ(a.inliers, b.inliers);
}

TEST(G2oWrite, ReadsBackToTheSameBits) {
  RandomStream random(1, "round trip");
  const auto measure = [&](std::size_t from, std::size_t to, double scale) {
    return RelativePose::from_covariance(from, to, test::random_pose(random),
                                         test::random_covariance(random, scale));
  };
  MeasurementLog log(Pose{1.0 / 3.0, -2e5, 0.1});
  for (std::size_t k = 1; k <= 30; ++k) {
    log.add_keyframe(measure(k - 1, k, 1e-16));
    for (std::size_t c = 0; c + 3 < k; c += 4) {
      RelativePose loop = c % 8 == 0 ? measure(c, k, 1e8) : measure(k, c, 1e-3);
      if (c % 3 == 0) loop.inliers = static_cast<int>(10 + c);
      log.add_registration(loop);
    }
  }
  for (const bool own_ids : {false, true}) {
    for (std::int64_t k = 0; own_ids && k <= 30; ++k) log.ids.push_back(5 + 3 * k);
    const MeasurementLog again = parse(to_g2o(log));
    ASSERT_EQ(again.size(), log.size());
    EXPECT_EQ(again.origin(), log.origin());
    EXPECT_EQ(again.ids.back(), own_ids ? 95 : 30);
    for (std::size_t k = 1; k < log.size(); ++k) {
      expect_same_bits(again.arrival(k).step, log.arrival(k).step);
      ASSERT_EQ(again.arrival(k).registrations.size(), log.arrival(k).registrations.size());
      for (std::size_t i = 0; i < log.arrival(k).registrations.size(); ++i) {
        expect_same_bits(again.arrival(k).registrations[i], log.arrival(k).registrations[i]);
      }
    }
    EXPECT_EQ(*again.guess, log.odometry());
    EXPECT_EQ(to_g2o(again), to_g2o(log));
  }
}

TEST(G2oWrite, AFileIsReadAsItsText) {
  const test::TemporaryFolder folder;
  const MeasurementLog log = parse("EDGE_SE2 0 1 1 0 0" + kInformation);
  write_file(folder / "log.g2o", to_g2o(log));
  EXPECT_EQ(to_g2o(read_g2o(folder / "log.g2o")), to_g2o(log));
}

}  // namespace
}  // namespace fathom

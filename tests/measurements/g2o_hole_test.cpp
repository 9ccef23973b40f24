// Graphs without an odometry edge here or there, and graphs in several components.

#include <string>
#include <utility>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/graph_check.hpp"
#include "measurements/parsed_graph.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using test::parse;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

std::string edge(int from, int to, double x) {
  return "EDGE_SE2 " + std::to_string(from) + " " + std::to_string(to) + " " + std::to_string(x) +
         " 0 0 1 0 0 1 0 1\n";
}

TEST(G2oHole, IsAStepThatNoEdgeMeasures) {
  const MeasurementLog log = parse(edge(0, 1, 1) + edge(0, 2, 2) + edge(2, 3, 1));
  EXPECT_EQ(log.hole_count(), 1U);
  const RelativePose& step = log.arrival(2).step;
  EXPECT_TRUE(step.is_hole);
  EXPECT_EQ(step.motion, Pose{});
  EXPECT_NEAR(step.covariance()(0, 0), 1e4, 1e-9);
  EXPECT_NEAR(step.covariance()(2, 2), 9.8696044, 1e-6);
  EXPECT_EQ(log.arrival(2).registrations.size(), 1U);
  EXPECT_EQ(log.edges().size(), 3U);
  // Three edges and three free poses: nothing contradicts anything.
  EXPECT_EQ(degrees_of_freedom(log), 0.0);
}

TEST(G2oHole, IsGuessedByTheVerticesAndAsWideAsTold) {
  GraphOptions options;
  options.gap_sigma_m = 5.0;
  options.gap_sigma_rad = 0.5;
  const MeasurementLog log =
      parse("VERTEX_SE2 0 0 0 0\nVERTEX_SE2 1 1 0 1.5707963267948966\nVERTEX_SE2 2 1 2 0\n" +
                edge(0, 1, 1) + edge(2, 0, 2),
            options);
  const RelativePose& step = log.arrival(2).step;
  EXPECT_NEAR(step.motion.x, 2.0, 1e-15);
  EXPECT_NEAR(step.motion.y, 0.0, 1e-15);
  EXPECT_NEAR(step.covariance()(1, 1), 25.0, 1e-12);
  EXPECT_NEAR(step.covariance()(2, 2), 0.25, 1e-15);
}

TEST(G2oHole, AsDeclaredInTheFile) {
  const std::string text = edge(0, 1, 1) + "# hole 1 2 3 4 0.5 0.25 0 0 0.25 0 0.5\n";
  const RelativePose step = parse(text + edge(0, 2, 2)).arrival(2).step;
  EXPECT_EQ(step.motion, (Pose{3, 4, 0.5}));
  EXPECT_EQ(step.information(0, 0), 0.25);
  // A comment that is no declaration is a comment.
  for (const char* comment :
       {"# hole\n", "# hole 1 2 3 4 0.5 0.25 0 0 0.25 0\n", "# hole 1 2 nan 4 0.5 1 0 0 1 0 1\n",
        "# hole 1 2 3 4 0.5 1 0 0 1 0 -1\n", "# hole in one\n"}) {
    EXPECT_EQ(parse(comment + edge(0, 1, 1) + edge(0, 2, 2)).arrival(2).step.motion, Pose{});
  }
}

// A loop over a declared hole, as a log has it whose registrations or false loops join its ends.
TEST(G2oHole, StaysOneWhereARegistrationJoinsItsEnds) {
  const std::string hole = "# hole 1 2 3 4 0.5 0.25 0 0 0.25 0 0.5\n";
  for (const auto& [from, to] : {std::pair{1, 2}, std::pair{2, 1}}) {
    const std::string text = edge(0, 1, 1) + hole + edge(from, to, 7) + edge(2, 3, 1);
    const MeasurementLog log = parse(text);
    EXPECT_EQ(log.hole_count(), 1U);
    EXPECT_EQ(log.arrival(2).step.motion, (Pose{3, 4, 0.5}));
    ASSERT_EQ(log.arrival(2).registrations.size(), 1U);
    EXPECT_EQ(log.arrival(2).registrations[0].motion.x, 7.0);
    const MeasurementLog again = parse(to_g2o(log));
    EXPECT_EQ(again.hole_count(), 1U);
    EXPECT_EQ(again.registration_count(), 1U);
    const test::TemporaryFolder folder;
    write_file(folder / "g.g2o", text);
    const GraphSummary graph = summarise_graph(folder / "g.g2o");
    EXPECT_EQ(graph.holes, 1U);
    EXPECT_EQ(graph.odometry_edges, 2U);
    EXPECT_EQ(graph.loops, 1U);
  }
}

const std::string kThree = edge(0, 1, 1) + edge(1, 4, 1) + edge(2, 3, 1) + edge(7, 8, 1);

TEST(G2oComponents, SeveralAreRefusedWithTheirList) {
  const std::string message = input_error_of([] { parse(kThree); });
  EXPECT_THAT(message, AllOf(HasSubstr("graph.g2o:3: "), HasSubstr("3 components"),
                             HasSubstr("1: 3 poses, 0 to 4; 2: 2 poses, 2 to 3; 3: 2 poses"),
                             HasSubstr("borders at 1|2, 3|4, 4|7"), HasSubstr("--component K")));
  EXPECT_EQ(message.find('\n'), std::string::npos);
  // One of each may be fixed: what is wrong is that there are several.
  EXPECT_THAT(input_error_of([] { parse(kThree + "FIX 0\nFIX 7\n"); }), HasSubstr("3 components"));
  std::string many;
  for (int i = 0; i < 1000; ++i) many += edge(2 * i, 2 * i + 1, 1);
  EXPECT_THAT(input_error_of([&] { parse(many); }),
              AllOf(HasSubstr("1000 components"), HasSubstr("and 996 more")));
}

TEST(G2oComponents, OneOfThemKeepsItsIds) {
  GraphOptions options;
  options.component = 1;
  const MeasurementLog first = parse(kThree + "FIX 7\nFIX 0\n", options);
  EXPECT_THAT(first.ids, ElementsAre(0, 1, 4));
  EXPECT_EQ(first.hole_count(), 0U);
  options.component = 3;
  EXPECT_THAT(parse(kThree + "FIX 7\n", options).ids, ElementsAre(7, 8));
  EXPECT_THAT(input_error_of([&] { parse(kThree + "FIX 8\n", options); }),
              HasSubstr("only the lowest id (7)"));
  options.component = 4;
  EXPECT_THAT(input_error_of([&] { parse(kThree, options); }),
              HasSubstr("graph.g2o: has no component 4; expected 1 to 3"));
  options.component = 1;
  EXPECT_EQ(parse(edge(0, 1, 1), options).size(), 2U);
}

// Priors join what they determine: a heading and a position, or two positions.
TEST(G2oComponents, TheWorldJoinsWhatPriorsHold) {
  const std::string two = edge(0, 1, 1) + edge(2, 3, 1);
  const std::string fixes = "EDGE_PRIOR_SE2_XY 2 5 5 1 0 1\nEDGE_PRIOR_SE2_XY 3 6 5 1 0 1\n";
  const MeasurementLog log = parse(two + "FIX 0\n" + fixes);
  EXPECT_EQ(log.hole_count(), 1U);
  EXPECT_TRUE(log.start().is_fixed());
  // Four fixes' rows, and the three freedoms of a pose behind a hole.
  EXPECT_EQ(degrees_of_freedom(log), 1.0);
  // Without FIX nothing says where the first component is.
  EXPECT_THAT(input_error_of([&] { parse(two + fixes); }), HasSubstr("2 components"));
  EXPECT_TRUE(parse(two + fixes + "EDGE_PRIOR_SE2 0 0 0 0 1 0 0 1 0 1\n").start().is_free);
  // One fix alone leaves the heading open.
  EXPECT_THAT(input_error_of([&] { parse(two + "FIX 0\nEDGE_PRIOR_SE2_XY 2 5 5 1 0 1\n"); }),
              HasSubstr("2 components"));
  EXPECT_NO_THROW(parse(two + "FIX 0\nEDGE_PRIOR_SE2 2 5 5 0 1 0 0 1 0 1\n"));
}

TEST(GraphCheck, CountsHolesComponentsAndPriors) {
  const test::TemporaryFolder folder;
  write_file(folder / "g.g2o", edge(0, 1, 1) + edge(0, 2, 2) + edge(4, 5, 1) +
                                   "EDGE_PRIOR_SE2 0 0 0 0 4 0 0 100 0 0\n"
                                   "EDGE_PRIOR_SE2 0 0 0 0 0 0 0 0 0 25\n"
                                   "EDGE_PRIOR_SE2 1 0 0 0 1 0 0 1 0 400\n"
                                   "EDGE_PRIOR_SE2_XY 2 0 0 0 0 0\n");
  const GraphSummary graph = summarise_graph(folder / "g.g2o");
  EXPECT_EQ(graph.holes, 1U);
  EXPECT_EQ(graph.odometry_edges, 2U);
  EXPECT_EQ(graph.loops, 1U);
  ASSERT_EQ(graph.components.size(), 2U);
  EXPECT_EQ(graph.components[1].first_id, 4);
  EXPECT_THAT(graph.borders, ElementsAre(Pair(2, 4)));
  EXPECT_EQ(graph.priors.of_heading, 1U);
  EXPECT_EQ(graph.priors.of_position, 1U);
  EXPECT_EQ(graph.priors.of_both, 1U);
  EXPECT_EQ(graph.priors.of_nothing, 1U);
  EXPECT_DOUBLE_EQ(graph.priors.smallest_sigma_m, 0.1);
  EXPECT_DOUBLE_EQ(graph.priors.largest_sigma_m, 1.0);
  EXPECT_DOUBLE_EQ(graph.priors.smallest_sigma_rad, 0.05);
  EXPECT_DOUBLE_EQ(graph.priors.largest_sigma_rad, 0.2);
  EXPECT_FALSE(graph.is_start_fixed);
  EXPECT_THAT(graph.faults, ElementsAre(HasSubstr("2 components")));
}

// A prior of 0.3 m that is off by 0.3 m: one of its two degrees is measured twice.
TEST(GraphCheck, TheScaleOfInformationCountsPriors) {
  const MeasurementLog log =
      parse(edge(0, 1, 1) + edge(0, 1, 1.5) + "FIX 0\nEDGE_PRIOR_SE2_XY 1 2 0 9 0 9\n");
  EXPECT_EQ(degrees_of_freedom(log), 5.0);
  const std::vector<Pose> at{{0, 0, 0}, {1.5, 0, 0}};
  const auto scale = information_scale(log, at);
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->per_degree_of_freedom, (0.25 + 9 * 0.25) / 5, 1e-12);
  EXPECT_NEAR(scale->squared, (0.25 + 81 * 0.25) / 5, 1e-12);
  EXPECT_FALSE(information_scale(parse(edge(0, 1, 1) + edge(0, 2, 2)), {}));
}

}  // namespace
}  // namespace fathom

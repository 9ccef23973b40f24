// Graphs as other programs write them: information in the order of the other tag, keys of 64 bits,
// landmarks, EQUIV, edges from a pose to itself.

#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/measurements/graph_check.hpp"
#include "fathom/measurements/graph_conversion.hpp"
#include "fathom/measurements/graph_numbers.hpp"
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
using testing::Not;
using testing::Pair;
using testing::SizeIs;
using testing::StartsWith;

std::string refusal_of(const std::string& text, const GraphOptions& options = {}) {
  const std::string message = input_error_of([&] { parse(text, options); });
  EXPECT_EQ(message.find('\n'), std::string::npos);
  EXPECT_LT(message.size(), 300U) << message;
  return message;
}

std::string conversion_error_of(const std::string& text, GraphFormat to) {
  return input_error_of([&] { convert_graph(text, "graph.g2o", to); });
}

GraphSummary summary_of(const std::string& text, const GraphOptions& options = {}) {
  const test::TemporaryFolder folder;
  write_file(folder / "g.g2o", text);
  return summarise_graph(folder / "g.g2o", options);
}

// Information in the order of g2o (xx xy xt yy yt tt) and of TORO (xx xy yy tt xt yt).
const std::string kOfG2o = " 100 1 2 200 3 300\n";
const std::string kOfToro = " 100 1 200 300 2 3\n";
const std::string kFirst = " 0 1 1 0 0";
const std::string kSecond = " 1 2 1 0 0";

TEST(GraphDialects, InformationInTheOrderOfTheOtherTag) {
  for (const auto& [tag, other, information] :
       {std::tuple{"EDGE2", "EDGE_SE2", " 100 0 0 200 0 300\n"},
        std::tuple{"EDGE_SE2", "EDGE2", " 100 0 200 300 0 0\n"}}) {
    const std::string text =
        tag + kFirst + information + tag + kSecond + information + tag + " 0 2 2 0 0" + information;
    const std::string message = refusal_of(text);
    EXPECT_THAT(message, AllOf(StartsWith("graph.g2o:1: "), HasSubstr("not positive definite"),
                               HasSubstr("3 of 3 " + std::string(tag) + " lines"),
                               HasSubstr(std::string("in the order of ") + other)));
    EXPECT_THAT(conversion_error_of(text, GraphFormat::g2o), HasSubstr(message.substr(12)));
    EXPECT_THAT(summary_of(text).faults[0], HasSubstr("in the order of"));
    // The remedy.
    std::string renamed;
    for (const std::string& line : {kFirst, kSecond}) renamed += other + line + information;
    Eigen::Matrix3d diagonal = Eigen::Vector3d(100, 200, 300).asDiagonal();
    EXPECT_EQ(parse(renamed).arrival(2).step.information, diagonal);
  }
}

TEST(GraphDialects, EdgesThatNoOneOrderFitsAreFaultsOfTheirOwn) {
  // Each is positive definite in one order alone.
  const std::string mixed =
      "EDGE2" + kFirst + " 100 0 200 300 0 0\nEDGE2" + kSecond + " 100 0 0 200 0 300\n";
  EXPECT_THAT(refusal_of(mixed),
              AllOf(StartsWith("graph.g2o:2: "), HasSubstr("not positive definite"),
                    Not(HasSubstr("order"))));
  EXPECT_THAT(refusal_of("EDGE_SE2" + kFirst + " 1 2 0 1 0 1\n"), Not(HasSubstr("order")));
  // Full matrices can be positive definite in both orders: the tag counts.
  Eigen::Matrix3d information;
  information << 100, 1, 2, 1, 200, 3, 2, 3, 300;
  EXPECT_EQ(parse("EDGE2" + kFirst + kOfToro).arrival(1).step.information, information);
  EXPECT_EQ(parse("EDGE_SE2" + kFirst + kOfG2o).arrival(1).step.information, information);
}

TEST(GraphDialects, KeysOfGtsam) {
  // Symbols x0, x1, x2 of GTSAM.
  const std::string text = "EDGE_SE2 8646911284551352321 8646911284551352322 2 0 0" + kOfG2o +
                           "EDGE_SE2 8646911284551352320 8646911284551352321 1 0 0" + kOfG2o;
  const MeasurementLog log = parse(text);
  EXPECT_TRUE(has_large_ids(log));
  EXPECT_THAT(stamps_of(log), ElementsAre(0, 1, 2));
  EXPECT_EQ(log.arrival(2).step.motion.x, 2);
  EXPECT_EQ(ids_csv(log),
            "stamp,id\n0,8646911284551352320\n1,8646911284551352321\n2,8646911284551352322\n");
  EXPECT_THAT(graph_remarks(log),
              ElementsAre(HasSubstr("trajectories have 0 to 2 in their place")));
  EXPECT_EQ(parse(to_g2o(log)).ids, log.ids);
  EXPECT_THAT(convert_graph(text, "g", GraphFormat::toro).text,
              HasSubstr("EDGE2 8646911284551352320 8646911284551352321 1 0 0 100 1 200 300 2 3\n"));
  const MeasurementLog small = parse("EDGE_SE2 7 9000000000 1 0 0" + kOfG2o);
  EXPECT_FALSE(has_large_ids(small));
  EXPECT_THAT(stamps_of(small), ElementsAre(7, 9'000'000'000));
  EXPECT_THAT(graph_remarks(small), ElementsAre());
}

TEST(GraphRemarks, NameMeasurementsThatASumDoesNotCarry) {
  const std::string chain =
      "EDGE_SE2 3 4 1 0 0 1e-6 0 0 1e-6 0 1\nEDGE_SE2 4 5 1 0 0 1 0 0 1 0 1\n";
  EXPECT_THAT(graph_remarks(parse(chain + "EDGE_SE2 3 5 2 0 0 1e9 0 0 1e9 0 1\n")), ElementsAre());
  EXPECT_THAT(graph_remarks(parse(chain + "EDGE_SE2 3 5 2 0 0 1e12 0 0 1e12 0 1\n")),
              ElementsAre(HasSubstr("poses 3 and 5 has position information of 1e+12, 1e+18 times "
                                    "the 1e-06 of poses 3 and 4")));
}

TEST(GraphDialects, EquivIsRefusedByName) {
  const std::string text = "EDGE2" + kFirst + kOfToro + "EQUIV 0 1\n";
  EXPECT_THAT(refusal_of(text), AllOf(StartsWith("graph.g2o:2: EQUIV says that two ids are one"),
                                      HasSubstr("in place of the other")));
  for (const GraphFormat to : {GraphFormat::g2o, GraphFormat::toro}) {
    EXPECT_THAT(conversion_error_of(text, to), HasSubstr("graph.g2o:2: EQUIV says"));
  }
}

const std::string kWithLandmarks =
    "VERTEX_SE2 0 0 0 0\nVERTEX_XY 7 1 1\nVERTEX_SE2 1 1 0 0\nEDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n"
    "EDGE_SE2_XY 0 7 1 1 1 0 1\nEDGE_SE2_XY 1 7 0 1 1 0 1 # seen\n";

TEST(GraphDialects, LandmarksAreRefusedOrLeftOutOnDemand) {
  EXPECT_THAT(refusal_of(kWithLandmarks),
              AllOf(StartsWith("graph.g2o:2: landmarks (1 VERTEX_XY, 2 EDGE_SE2_XY)"),
                    HasSubstr("convert --drop-landmarks")));
  EXPECT_THAT(summary_of(kWithLandmarks).faults, SizeIs(1));
  EXPECT_THAT(conversion_error_of(kWithLandmarks, GraphFormat::toro), HasSubstr("landmarks (1 VE"));
  EXPECT_EQ(convert_graph(kWithLandmarks, "g", GraphFormat::g2o).text, kWithLandmarks);
  ConversionOptions drop;
  drop.drop_landmarks = true;
  for (const GraphFormat to : {GraphFormat::g2o, GraphFormat::toro}) {
    const ConvertedGraph graph = convert_graph(kWithLandmarks, "g", to, drop);
    EXPECT_THAT(graph.landmarks, ElementsAre(Pair("VERTEX_XY", 1), Pair("EDGE_SE2_XY", 2)));
    EXPECT_THAT(graph.left_out, ElementsAre());
    EXPECT_THAT(graph.text, AllOf(Not(HasSubstr("XY")), HasSubstr("# seen")));
    EXPECT_EQ(parse(graph.text).size(), 2U);
  }
}

TEST(GraphDialects, AnEdgeWithASensorOffsetIsNoLandmark) {
  const std::string text = "EDGE_SE2" + kFirst + kOfG2o + "EDGE_SE2_OFFSET 0 1 0 0 1 0 0\n";
  EXPECT_THAT(refusal_of(text), HasSubstr("unknown tag 'EDGE_SE2_OFFSET'"));
  EXPECT_THAT(conversion_error_of(text, GraphFormat::toro), HasSubstr("'EDGE_SE2_OFFSET'"));
  EXPECT_EQ(convert_graph(text, "g", GraphFormat::g2o).text, text);
  // Its parameters alone say nothing.
  const std::string parameters = "PARAMS_SE2OFFSET 0 0 0 0\nEDGE_SE2" + kFirst + kOfG2o;
  EXPECT_EQ(parse(parameters).size(), 2U);
  EXPECT_EQ(convert_graph(parameters, "g", GraphFormat::g2o).text, parameters);
  EXPECT_THAT(convert_graph(parameters, "g", GraphFormat::toro).left_out,
              ElementsAre(Pair("PARAMS_SE2OFFSET", 1)));
}

const std::string kWithSelfEdges = "EDGE_SE2" + kFirst + kOfG2o +
                                   "# inliers 5\nEDGE_SE2 1 1 1 0 0" + kOfG2o + "EDGE_SE2" +
                                   kSecond + kOfG2o + "EDGE2 2 2 0 0 0.5 100 1 200 300 2 3\n";

TEST(GraphDialects, EdgesFromAPoseToItself) {
  EXPECT_THAT(refusal_of(kWithSelfEdges),
              AllOf(StartsWith("graph.g2o:3: an edge from pose 1 to itself"),
                    HasSubstr("--drop-self-edges or dataset.drop_self_edges")));
  EXPECT_THAT(summary_of(kWithSelfEdges).faults, SizeIs(2));
  GraphOptions drop;
  drop.drop_self_edges = true;
  const MeasurementLog log = parse(kWithSelfEdges, drop);
  EXPECT_EQ(log.self_edges, 2U);
  EXPECT_EQ(log.size(), 3U);
  EXPECT_EQ(log.registration_count(), 0U);
  EXPECT_FALSE(log.arrival(2).step.inliers) << "those of the edge that is left out";
  EXPECT_THAT(graph_remarks(log), ElementsAre("2 edges from a pose to itself left out"));
  EXPECT_EQ(with_start_of_priors(log, "g").self_edges, 2U);
  EXPECT_EQ(summary_of(kWithSelfEdges, drop).edges, 2U);
  EXPECT_THAT(summary_of(kWithSelfEdges, drop).faults, ElementsAre());

  EXPECT_THAT(conversion_error_of(kWithSelfEdges, GraphFormat::toro), HasSubstr("to itself"));
  ConversionOptions without;
  without.drop_self_edges = true;
  const std::string one = "EDGE_SE2" + kFirst + kOfG2o;
  const std::string text = one + "EDGE_SE2 1 1 1 0 0" + kOfG2o;
  const ConvertedGraph graph = convert_graph(text, "g", GraphFormat::g2o, without);
  EXPECT_EQ(graph.self_edges, 1U);
  EXPECT_EQ(graph.edges, 1U);
  EXPECT_EQ(graph.text, one);
}

}  // namespace
}  // namespace fathom

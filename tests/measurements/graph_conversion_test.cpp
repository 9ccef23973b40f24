#include "fathom/measurements/graph_conversion.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/data.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::input_error_of;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Pair;

const std::string kG2o =
    "# a graph\n"
    "VERTEX_SE2 0 0 0 0\n"
    "VERTEX_SE2 1 1.00 2e-1 0.30\n"
    "# inliers 7\n"
    "EDGE_SE2 0 1 1 0.2 0.3 11 1 2 22 3 33 # xx xy xt yy yt tt\n"
    "\n";

const std::string kToro =
    "# a graph\n"
    "VERTEX2 0 0 0 0\n"
    "VERTEX2 1 1.00 2e-1 0.30\n"
    "# inliers 7\n"
    "EDGE2 0 1 1 0.2 0.3 11 1 22 33 2 3 # xx xy xt yy yt tt\n"
    "\n";

ConvertedGraph converted(const std::string& content, GraphFormat to) {
  return convert_graph(content, "graph", to);
}

TEST(GraphConversion, ByHand) {
  const ConvertedGraph toro = converted(kG2o, GraphFormat::toro);
  EXPECT_EQ(toro.text, kToro);
  EXPECT_EQ(toro.vertices, 2U);
  EXPECT_EQ(toro.edges, 1U);
  EXPECT_TRUE(toro.left_out.empty());
  EXPECT_EQ(converted(kToro, GraphFormat::g2o).text, kG2o);
}

TEST(GraphConversion, AMixedFileIsWrittenInOneFormat) {
  EXPECT_EQ(converted(kG2o + "EDGE2 0 1 1 0.2 0.3 11 1 22 33 2 3\n", GraphFormat::g2o).text,
            kG2o + "EDGE_SE2 0 1 1 0.2 0.3 11 1 2 22 3 33\n");
  EXPECT_EQ(converted(kG2o, GraphFormat::g2o).text, kG2o);
}

TEST(GraphConversion, SaysWhatIsLeftOut) {
  const std::string more = "FIX 0\nEDGE_PRIOR_SE2 1 0 0 0 1 0 0 1 0 1 # a fix\nFIX 1\n";
  const ConvertedGraph toro = converted(kG2o + more, GraphFormat::toro);
  EXPECT_EQ(toro.text, kToro + "# a fix\n");
  EXPECT_THAT(toro.left_out, ElementsAre(Pair("FIX", 2), Pair("EDGE_PRIOR_SE2", 1)));
  EXPECT_EQ(converted(kG2o + more, GraphFormat::g2o).text, kG2o + more);
}

TEST(GraphConversion, RefusesWithFileAndLine) {
  const auto error_of = [](const std::string& content) {
    return input_error_of([&] { converted(content, GraphFormat::toro); });
  };
  EXPECT_THAT(error_of(kG2o + "FIX 0\nEDGE_SE2 0 1 1\n"), HasSubstr("graph:8: EDGE_SE2 takes"));
  EXPECT_THAT(error_of(kG2o + "EDGE_SE3 0 1\n"), HasSubstr("graph:7: unknown tag 'EDGE_SE3'"));
  EXPECT_THAT(error_of(kG2o + "VERTEX_SE2 9 0 nan 0\n"), HasSubstr("'nan'"));
  EXPECT_THAT(error_of(kG2o + "EDGE_SE2 0 9 0 0 0 1 0 0 1 0 1\n"), HasSubstr("vertex 9"));
  EXPECT_THAT(error_of("EDGE_SE2 0 1 0 0 0 1 2 0 1 0 1\n"), HasSubstr("not positive definite"));
  EXPECT_THAT(error_of(kG2o + "FIX" + std::string(2 << 20, ' ') + "0\n"),
              HasSubstr("graph:7: has more than a mebibyte"));
  EXPECT_THAT(error_of("FIX 0\n"), HasSubstr("holds no pose graph"));
  EXPECT_THAT(error_of(""), HasSubstr("holds no pose graph"));
}

void expect_same_graph(const MeasurementLog& a, const MeasurementLog& b) {
  ASSERT_EQ(a.ids, b.ids);
  EXPECT_EQ(a.guess, b.guess);
  const auto first = a.edges();
  const auto second = b.edges();
  ASSERT_EQ(first.size(), second.size());
  for (std::size_t e = 0; e < first.size(); ++e) {
    EXPECT_EQ(first[e].from, second[e].from);
    EXPECT_EQ(first[e].to, second[e].to);
    EXPECT_EQ(first[e].motion, second[e].motion);
    EXPECT_EQ(first[e].information, second[e].information);
  }
}

TEST(GraphConversion, RealGraphsKeepEveryBit) {
  for (const std::string name : {"intel", "CSAIL", "manhattan", "MIT", "M3500a", "ring"}) {
    SCOPED_TRACE(name);
    const std::string file = "pose_graphs/" + name + ".g2o";
    FATHOM_REQUIRE_DATA(file);
    const std::string content = read_file(test::data_path(file));
    const MeasurementLog graph = parse_g2o(content, name);
    const std::string toro = converted(content, GraphFormat::toro).text;
    EXPECT_EQ(toro.find("SE2"), std::string::npos);
    expect_same_graph(parse_g2o(toro, name), graph);
    const std::string g2o = converted(toro, GraphFormat::g2o).text;
    EXPECT_EQ(g2o.find("EDGE2"), std::string::npos);
    expect_same_graph(parse_g2o(g2o, name), graph);
  }
}

}  // namespace
}  // namespace fathom

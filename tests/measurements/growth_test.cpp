// Graphs are read in time by their size, whatever they are made of, and memory by their poses.

#include "support/growth.hpp"

#include <cstddef>
#include <fmt/format.h>
#include <string>

#include <gtest/gtest.h>

#include "fathom/measurements/connected_guess.hpp"
#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/loop_terms.hpp"
#include "fathom/measurements/shared_file.hpp"

namespace fathom {
namespace {

using test::growth_of;
using test::kFarBelowTheSquare;

const char* const kGrowingInformation = " 1 0 0 1 0 1\n";

std::string unit_edge(std::size_t from, std::size_t to) {
  return fmt::format("EDGE_SE2 {} {} 1 0 0{}", from, to, kGrowingInformation);
}

// Every step a hole that a comment declares; a chain of registrations over two poses each.
std::string graph_of_holes(std::size_t poses) {
  std::string text;
  for (std::size_t k = 1; k < poses; ++k) {
    text += fmt::format("# hole {} {} 1 0 0{}", k - 1, k, kGrowingInformation);
    if (k > 1) text += unit_edge(k - 2, k);
  }
  return text + unit_edge(0, 1) +
         fmt::format("# hole {} {} 1 0 0{}", poses - 1, poses, kGrowingInformation) +
         unit_edge(poses - 2, poses);
}

TEST(GraphGrowth, DeclaredHolesAreFoundByTheirPoses) {
  const auto read = [](std::size_t poses) {
    const MeasurementLog log = parse_g2o(graph_of_holes(poses), "holes.g2o");
    EXPECT_EQ(log.size(), poses + 1);
    EXPECT_EQ(log.hole_count(), poses);
  };
  EXPECT_LT(growth_of(read, 4000), kFarBelowTheSquare);
}

// The one place is handed on from the last pose to the first: a pass over all registrations in
// their order gives it to one more alone.
TEST(GraphGrowth, StretchesArePlacedInTimeByTheirNumber) {
  const auto place = [](std::size_t stretches) {
    std::string text;
    for (std::size_t k = 0; k <= stretches; ++k) {
      text += fmt::format("VERTEX_SE2 {} {} 0 0\n", k, k);
    }
    text += unit_edge(0, stretches);
    for (std::size_t k = 3; k <= stretches; k += 2) text += unit_edge(k - 2, k);
    for (std::size_t k = 4; k <= stretches; k += 2) text += unit_edge(k - 2, k);
    text += unit_edge(stretches - 1, stretches);
    const MeasurementLog log = parse_g2o(text, "stretches.g2o");
    const auto poses = connected_guess(log);
    ASSERT_EQ(poses.size(), stretches + 1);
    EXPECT_NEAR(poses[stretches].x, 1.0, 1e-9);
    EXPECT_NEAR(poses[stretches - 2].x, 0.0, 1e-9);
  };
  EXPECT_LT(growth_of(place, 2000), kFarBelowTheSquare);
}

// A pose that comes with its one measurement: no way leads there before, which is known at once.
TEST(GraphGrowth, LoopsAreClosedWhereAWayLeads) {
  const auto close = [](std::size_t poses) {
    const MeasurementLog log = parse_g2o(graph_of_holes(poses - 1), "holes.g2o");
    EXPECT_EQ(loop_terms(log).loops, 0U);
  };
  EXPECT_LT(growth_of(close, 2000), kFarBelowTheSquare);
}

// All between one pair of poses, and all alike.
TEST(GraphGrowth, SharedErrorsFindTheirEdges) {
  const auto read = [](std::size_t edges) {
    std::string graph = unit_edge(0, 1);
    std::string shared = "PICTURE 0 0 0 0\nPICTURE 2 0 0 0\n";
    for (std::size_t i = 0; i < edges; ++i) {
      graph += unit_edge(0, 2);
      shared += "REGISTRATION 0 2 1 0 0  0 0 0 0 0 0 0 0 0  0 0 0 0 0 0 0 0 0  1 0 0 1 0 1\n";
    }
    const SharedText text{shared, "graph.shared"};
    EXPECT_TRUE(parse_g2o(graph, "graph.g2o", {}, &text).tells_shared_errors());
  };
  EXPECT_LT(growth_of(read, 3000), kFarBelowTheSquare);
}

// Nothing is made by an id: these two are as far apart as ids can be.
TEST(GraphGrowth, IdsAreNames) {
  const MeasurementLog log = parse_g2o(
      "EDGE_SE2 0 4000000000 1 0 0 1 0 0 1 0 1\n"
      "EDGE_SE2 4000000000 9223372036854775807 1 0 0 1 0 0 1 0 1\n",
      "large.g2o");
  EXPECT_EQ(log.size(), 3U);
  EXPECT_EQ(log.ids.back(), 9223372036854775807);
}

}  // namespace
}  // namespace fathom

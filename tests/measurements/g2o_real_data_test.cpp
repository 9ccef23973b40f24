#include <string>

#include <gtest/gtest.h>

#include "fathom/measurements/g2o.hpp"
#include "support/data.hpp"

namespace fathom {
namespace {

/// Found by an independent reader: 30 lines of Python 3.11 with homogeneous matrices as lists, the
/// residual t2v(Z⁻¹ X_i⁻¹ X_k) and the odometry chained from the first vertex.
struct RealGraph {
  std::string name;
  std::size_t poses;
  std::size_t loops;
  double F_guess;  ///< negative where the file has no vertices
  double F_odometry;
};

void PrintTo(const RealGraph& graph, std::ostream* out) {
  *out << graph.name;
}

class G2oRealData : public testing::TestWithParam<RealGraph> {};

TEST_P(G2oRealData, CostsEqualThoseOfAnIndependentReader) {
  const RealGraph& graph = GetParam();
  const std::string file = "pose_graphs/" + graph.name + ".g2o";
  FATHOM_REQUIRE_DATA(file);
  const MeasurementLog log = read_g2o(test::data_path(file));
  EXPECT_EQ(log.size(), graph.poses);
  EXPECT_EQ(log.registration_count(), graph.loops);
  EXPECT_NEAR(chi2(log, log.odometry()), graph.F_odometry, 1e-6 * graph.F_odometry);
  ASSERT_EQ(log.guess.has_value(), graph.F_guess >= 0);
  if (log.guess) {
    EXPECT_NEAR(chi2(log, *log.guess), graph.F_guess, 1e-9 * graph.F_guess);
  }
  EXPECT_EQ(to_g2o(parse_g2o(to_g2o(log), "again")), to_g2o(log));
}

INSTANTIATE_TEST_SUITE_P(
    Graphs, G2oRealData,
    testing::Values(RealGraph{"intel", 1728, 785, 551.73573084974078, 57952.901145894226},
                    RealGraph{"CSAIL", 1045, 128, -1, 2218642.085830735},
                    RealGraph{"manhattan", 3500, 1954, -1, 23318531317.474522},
                    RealGraph{"MIT", 808, 20, 4414181662.5245953, 4414183266.8173008},
                    RealGraph{"M3500", 3500, 1954, 2566667.6592069212, 2566699.2135365657},
                    RealGraph{"M3500a", 3500, 1954, 58265012.556766853, 58264819.497562975},
                    RealGraph{"M3500b", 3500, 1954, 41329876.892514646, 41329971.551761784},
                    RealGraph{"M3500c", 3500, 1954, 45806409.265353359, 45806819.508841224},
                    RealGraph{"ring", 434, 26, 2041063.9253983609, 2041015.6053284281}),
    [](const auto& test) { return test.param.name; });

}  // namespace
}  // namespace fathom

// Other people's solvers as plug-ins, where they were found.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/plugin_files.hpp"
#include "support/data.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

class Adapters : public CommandLine {
 protected:
  std::string file_ = FATHOM_ADAPTER_FOLDER "mrpt.so";

  double chi2_of(const std::string& graph, const std::string& mode) {
    fathom_done({"solve", graph, "--plugin", file_, "--estimator", "mrpt", "--mode", mode, "--out",
                 "out", "--quiet"});
    return json_of("out/metrics.json").at("chi2").get<double>();
  }
};

#define FATHOM_REQUIRE_MRPT() \
  if (!std::filesystem::exists(file_)) GTEST_SKIP() << "built without MRPT"

TEST_F(Adapters, MrptStandsInAStudyBesideTheOthers) {
  FATHOM_REQUIRE_MRPT();
  write("s.yaml", std::string(kLog) + "plugins: [" + file_ +
                      "]\ntrials: 2\nestimators: [{type: mrpt}, {type: sparse_gauss_newton}]\n");
  fathom_done({"compare", "s.yaml", "--out", "study"});
  const nlohmann::json metrics = json_of("study/metrics.json");
  EXPECT_EQ(metrics.at(0).at("estimator"), "mrpt");
  const double ours = metrics.at(1).at("chi2").get<double>();
  EXPECT_NEAR(metrics.at(0).at("chi2").get<double>(), ours, 1e-3 * ours);
}

TEST_F(Adapters, MrptReachesTheOptimumOfRealGraphs) {
  FATHOM_REQUIRE_MRPT();
  for (const auto& [name, optimum] :
       {std::pair("intel", 45.0047), {"CSAIL", 40.5551}, {"ring", 11.1631}}) {
    const std::string graph = std::string("pose_graphs/") + name + ".g2o";
    FATHOM_REQUIRE_DATA(graph);
    EXPECT_NEAR(chi2_of(data_path(graph).string(), "batch"), optimum, 1e-4 * optimum) << name;
  }
}

TEST_F(Adapters, MrptRefusesAGate) {
  FATHOM_REQUIRE_MRPT();
  write("g.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  EXPECT_THAT(refusal({"solve", "g.g2o", "--out", "out", "--plugin", file_, "--estimator", "mrpt",
                       "--set", "estimator.gate_probability=0.99"}),
              HasSubstr("there is no covariance to gate with"));
}

}  // namespace
}  // namespace fathom::test

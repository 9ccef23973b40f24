// Other people's solvers as plug-ins, where they were found.

#include <regex>
#include <set>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/plugin_files.hpp"
#include "support/data.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

struct Adapter {
  std::string plugin;
  std::string estimator;
  std::vector<std::string> exact;   ///< settings with which it ends at the least F
  std::set<std::string> may_break;  ///< clauses of the contract, docs/adapters.md
  bool has_covariances = true;
  bool can_batch = true;
};

std::ostream& operator<<(std::ostream& out, const Adapter& adapter) {
  return out << adapter.estimator;
}

class Adapters : public CommandLine, public ::testing::WithParamInterface<Adapter> {
 protected:
  void SetUp() override {
    if (!std::filesystem::exists(file())) {
      GTEST_SKIP() << "built without " << GetParam().plugin << " (docs/adapters.md)";
    }
  }

  std::string file() const { return FATHOM_ADAPTER_FOLDER + GetParam().plugin + ".so"; }

  std::vector<std::string> solve(const std::string& graph) const {
    std::vector<std::string> words{"solve", graph,         "--plugin",
                                   file(),  "--estimator", GetParam().estimator,
                                   "--out", "out",         "--quiet"};
    for (const std::string& setting : GetParam().exact) {
      words.insert(words.end(), {"--set", "estimator." + setting});
    }
    return words;
  }
};

TEST_P(Adapters, StandInAStudyBesideTheOthers) {
  write("s.yaml", std::string(kLog) + "plugins: [" + file() + "]\ntrials: 2\nestimators: [{type: " +
                      GetParam().estimator + "}, {type: sparse_gauss_newton}]\n");
  fathom_done({"compare", "s.yaml", "--out", "study"});
  const nlohmann::json metrics = json_of("study/metrics.json");
  EXPECT_EQ(metrics.at(0).at("estimator"), GetParam().estimator);
  const double ours = metrics.at(1).at("chi2").get<double>();
  // Fluid relinearisation leaves what moves by less than its threshold, 0.1 by default.
  const double share = GetParam().can_batch ? 1e-2 : 0.1;
  EXPECT_NEAR(metrics.at(0).at("chi2").get<double>(), ours, share * ours);
}

TEST_P(Adapters, ReachTheOptimumOfRealGraphs) {
  for (const auto& [name, optimum] :
       {std::pair("intel", 45.0047), {"CSAIL", 40.5551}, {"ring", 11.1631}}) {
    const std::string graph = std::string("pose_graphs/") + name + ".g2o";
    FATHOM_REQUIRE_DATA(graph);
    fathom_done(solve(data_path(graph).string()));
    const nlohmann::json metrics = json_of("out/metrics.json");
    const double share = GetParam().can_batch ? 1e-4 : 2e-3;
    EXPECT_NEAR(metrics.at("chi2").get<double>(), optimum, share * optimum) << name;
  }
}

// The contract is about covariances, failures, holes and fixes, too.
TEST_P(Adapters, KeepTheContractButForWhatThePageSays) {
  if (!GetParam().has_covariances) GTEST_SKIP() << "has no covariances, which most clauses need";
  const Ended result = fathom({"conformance", GetParam().estimator, "--plugin", file()});
  std::set<std::string> broken;
  const std::regex breaks(GetParam().estimator + ": breaks (\\w+):");
  const std::string text = result.out + result.err;
  for (std::sregex_iterator found(text.begin(), text.end(), breaks), end; found != end; ++found) {
    broken.insert((*found)[1]);
  }
  EXPECT_THAT(GetParam().may_break, IsSupersetOf(broken)) << text;
  EXPECT_THAT(text, HasSubstr("clauses"));
}

TEST_P(Adapters, RefuseAGateWhereThereIsNoInnovation) {
  if (!GetParam().can_batch) GTEST_SKIP() << "has no batch mode";
  write("g.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  std::vector<std::string> words = solve("g.g2o");
  words.insert(words.end(), {"--mode", "batch", "--set", "estimator.gate_probability=0.99"});
  EXPECT_THAT(refusal(words),
              AllOf(HasSubstr("gate_probability: "),
                    HasSubstr(GetParam().has_covariances ? "a batch solve has no innovation to gate"
                                                         : "there is no covariance to gate with")));
}

INSTANTIATE_TEST_SUITE_P(
    Every, Adapters,
    ::testing::Values(Adapter{"gtsam",
                              "gtsam",
                              {"method=gauss_newton", "exact_jacobians=true"},
                              {"beyond_doubles", "holes_in_batch", "free_start"}},
                      Adapter{"gtsam",
                              "gtsam_isam2",
                              {"relinearize_threshold=0.01", "relinearize_skip=1",
                               "exact_jacobians=true"},
                              {"loops_at_once", "beyond_doubles", "either_direction",
                               "nanometre_fixes", "holes_and_loops"},
                              true,
                              false},
                      Adapter{"g2o", "g2o", {}, {"beyond_doubles", "free_start"}},
                      Adapter{"mrpt", "mrpt", {}, {}, false}),
    [](const ::testing::TestParamInfo<Adapter>& one) { return one.param.estimator; });

// Its cost is another one: near the optimum of F, not at it.
TEST_F(CommandLine, SESyncIsCalledByCommand) {
  const std::string program = FATHOM_ADAPTER_FOLDER "se_sync";
  if (!std::filesystem::exists(program)) GTEST_SKIP() << "built without SE-Sync";
  FATHOM_REQUIRE_DATA("pose_graphs/ring.g2o");
  fathom_done({"solve", data_path("pose_graphs/ring.g2o").string(), "--estimator", "command",
               "--mode", "batch", "--set", "estimator.command=" + program + " {input} {output}",
               "--out", "out", "--quiet"});
  const double chi2 = json_of("out/metrics.json").at("chi2").get<double>();
  EXPECT_GT(chi2, 11.1631);
  EXPECT_LT(chi2, 11.17);
}

}  // namespace
}  // namespace fathom::test

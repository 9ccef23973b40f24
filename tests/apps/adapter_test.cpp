// Other people's solvers as plug-ins, where they were found.

#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/plugin_files.hpp"
#include "fathom/geometry/pose.hpp"
#include "support/data.hpp"
#include "support/requirements.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

struct Adapter {
  std::string label;
  std::string plugin;
  std::string estimator;
  std::vector<std::string> exact;   ///< settings with which it ends at the least F
  std::set<std::string> may_break;  ///< clauses of the contract, docs/adapters.md
  bool has_covariances = true;
  bool can_batch = true;
};

std::ostream& operator<<(std::ostream& out, const Adapter& adapter) {
  return out << adapter.label;
}

class Adapters : public CommandLine, public ::testing::WithParamInterface<Adapter> {
 protected:
  void SetUp() override { FATHOM_REQUIRE_FEATURE(GetParam().plugin); }

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
  if (!GetParam().has_covariances)
    GTEST_SKIP() << "does not apply: has no covariances, which most clauses need";
  if (GetParam().label != GetParam().estimator) GTEST_SKIP() << "does not apply: takes no settings";
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

// Four sides of ten steps, and loops from each keyframe of the fourth side to the first keyframes;
// `error` is that of their x.
std::string square(double error) {
  std::ostringstream graph;
  graph.precision(17);
  std::vector<Pose> poses;
  const auto add = [&](const Pose& pose) {
    graph << "VERTEX_SE2 " << poses.size() << ' ' << pose.x << ' ' << pose.y << ' ' << pose.theta
          << '\n';
    poses.push_back(pose);
  };
  const auto edge = [&](std::size_t from, std::size_t to, double off) {
    const Pose z = between(poses[from], poses[to]);
    graph << "EDGE_SE2 " << from << ' ' << to << ' ' << z.x + off << ' ' << z.y << ' ' << z.theta
          << " 100 3 2 80 1 900\n";
  };
  add({10.0, 20.0, 1.5});
  for (std::size_t k = 1; k <= 40; ++k) {
    add(compose(poses.back(), {1.0, 0.05, k % 10 == 0 ? 1.55 : 0.01}));
    edge(k - 1, k, 0.0);
    if (k > 30) edge(k, k - 31, error);
  }
  return graph.str();
}

// Some solvers begin by putting node 0 at the origin, and none may be torn from its map.
TEST_P(Adapters, KeepTheMapWhereItBegins) {
  write("square.g2o", square(0.3));
  fathom_done({"solve", "square.g2o", "--out", "ours", "--quiet"});
  const double optimum = json_of("ours/metrics.json").at("chi2").get<double>();
  fathom_done(solve("square.g2o"));
  EXPECT_NEAR(json_of("out/metrics.json").at("chi2").get<double>(), optimum, 1e-2 * optimum);
  std::ifstream file(path("out/trajectory.tum"));
  std::string line;
  while (std::getline(file, line) && line.starts_with('#')) {
  }
  std::istringstream first(line);
  std::string time;
  double x = 0.0;
  double y = 0.0;
  first >> time >> x >> y;
  EXPECT_EQ(x, 10.0);
  EXPECT_EQ(y, 20.0);
}

// Where nothing is to be lowered, the last digit of F rises and falls.
TEST_P(Adapters, UseLoopsThatAgree) {
  write("square.g2o", square(0.0));
  for (const std::string mode : {"incremental", "batch"}) {
    if (mode == "batch" && !GetParam().can_batch) continue;
    std::vector<std::string> words = solve("square.g2o");
    words.insert(words.end(), {"--mode", mode});
    fathom_done(words);
    const nlohmann::json metrics = json_of("out/metrics.json");
    EXPECT_EQ(metrics.at("outcome"), "converged") << mode;
    EXPECT_EQ(metrics.at("loop_closures"), 10) << mode;
  }
}

TEST_P(Adapters, RefuseAGateWhereThereIsNoInnovation) {
  if (!GetParam().can_batch) GTEST_SKIP() << "does not apply: has no batch mode";
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
    ::testing::Values(
        Adapter{"gtsam",
                "gtsam",
                "gtsam",
                {"method=gauss_newton", "exact_jacobians=true"},
                {"beyond_doubles", "holes_in_batch", "free_start"}},
        Adapter{"gtsam_isam2",
                "gtsam",
                "gtsam_isam2",
                {"relinearize_threshold=0.01", "relinearize_skip=1", "exact_jacobians=true"},
                {"loops_at_once", "beyond_doubles", "either_direction", "nanometre_fixes"},
                true,
                false},
        Adapter{"g2o", "g2o", "g2o", {}, {"beyond_doubles"}},
        Adapter{"g2o_linear", "g2o", "g2o", {"method=slam2d_linear"}, {"beyond_doubles"}},
        Adapter{"mrpt", "mrpt", "mrpt", {}, {}, false}),
    [](const ::testing::TestParamInfo<Adapter>& one) { return one.param.label; });

// Its cost is another one: near the optimum of F, not at it.
TEST_F(CommandLine, SESyncIsCalledByCommand) {
  const std::string program = FATHOM_ADAPTER_FOLDER "se_sync";
  FATHOM_REQUIRE_FEATURE("se_sync");
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

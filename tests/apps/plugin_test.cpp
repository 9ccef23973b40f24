// Estimators of other people: plug-ins, and runs in processes of their own, through the real
// command line.

#include <algorithm>
#include <fstream>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/plugin_files.hpp"
#include "fathom/core/files.hpp"
#include "fathom/evaluation/metrics.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Plugins : public CommandLine {};

TEST_F(Plugins, AreListedWithTheirOptionsFromAFlagAndFromThePath) {
  const Ended by_flag = fathom_done({"list", "estimators", "--plugin", plugin("plugin_example")});
  EXPECT_THAT(by_flag.out,
              AllOf(HasSubstr("sparse_least_squares: pose-graph least squares"),
                    HasSubstr("(plug-in plugin_example.so)"), HasSubstr("estimator.tolerance")));
  surroundings_.environment = {{"FATHOM_PLUGIN_PATH", plugin("plugin_example")}};
  EXPECT_EQ(fathom_done({"list", "estimators"}).out, by_flag.out);
  fs::create_directory(path("folder"));
  fs::copy(plugin("plugin_example"), path("folder/plugin_example.so"));
  surroundings_.environment = {{"FATHOM_PLUGIN_PATH", "folder"}};
  EXPECT_EQ(fathom_done({"list", "estimators"}).out, by_flag.out);
}

TEST_F(Plugins, AreHeldAgainstTheContractAloneWhereNoNameIsGiven) {
  const std::string out = fathom_done({"conformance", "--plugin", plugin("plugin_example")}).out;
  EXPECT_THAT(out, testing::StartsWith("sparse_least_squares: keeps "));
  EXPECT_EQ(std::ranges::count(out, '\n'), 1) << out;
}

TEST_F(Plugins, AreRefusedInOneLine) {
  const auto refused = [&](const std::string& file) {
    return refusal({"list", "estimators", "--plugin", file});
  };
  EXPECT_THAT(refused("missing.so"), HasSubstr("'missing.so': there is no such plug-in"));
  EXPECT_THAT(refused("."), HasSubstr("'.': there is no such plug-in"));
  const std::string whole = read_file(plugin("plugin_example"));
  write("half.so", whole.substr(0, whole.size() / 2));
  EXPECT_THAT(refused("half.so"), HasSubstr("half.so"));
  write("text.so", "no shared object");
  EXPECT_THAT(refused("text.so"), HasSubstr("cannot be loaded"));
  EXPECT_THAT(refused(plugin("no_symbol")), HasSubstr("does not export fathom_plugin"));
  EXPECT_THAT(refused(plugin("other_version")), HasSubstr("was made for version 999"));
  EXPECT_THAT(refused(plugin("other_build")),
              HasSubstr("the alignment of Eigen (-march?) is 1024, expected"));
  EXPECT_THAT(refused(plugin("taken_name")),
              HasSubstr("estimator 'ekf': the name is taken, another one is there already"));
  EXPECT_THAT(refused(plugin("throwing")), HasSubstr("adding its estimators threw: no licence"));
  write("c.yaml", std::string(kLog) + "plugins: [missing.so]\nestimator: {type: ekf}\n");
  EXPECT_THAT(refusal({"run", "c.yaml"}), HasSubstr("c.yaml:5: plugins: 'missing.so'"));
}

// Pages that are missing kill who touches them, which loading may not do.
TEST_F(Plugins, CutShortAnywhereIsRefused) {
  const std::string whole = read_file(plugin("plugin_example"));
  for (const std::size_t cut : {std::size_t{1}, std::size_t{5000}, whole.size() / 3}) {
    write("cut.so", whole.substr(0, whole.size() - cut));
    EXPECT_THAT(refusal({"list", "estimators", "--plugin", "cut.so"}),
                HasSubstr("cut.so: is cut short: it has " + std::to_string(whole.size() - cut) +
                          " bytes, expected "));
  }
}

// All commands have the path, also those that need none of it.
TEST_F(Plugins, OfThePathWhatCannotBeLoadedIsLeftOutWithANote) {
  const std::string all =
      fathom_done({"list", "estimators", "--plugin", plugin("plugin_example")}).out;
  write("folder/broken.so", "no shared object");
  surroundings_.environment = {
      {"FATHOM_PLUGIN_PATH", "missing.so:folder:" + plugin("plugin_example")}};
  const Ended listed = fathom({"list", "estimators"});
  EXPECT_EQ(listed.status, 0);
  EXPECT_EQ(listed.out, all);
  EXPECT_THAT(listed.err,
              AllOf(HasSubstr("fathom: note: FATHOM_PLUGIN_PATH: left out: 'missing.so': there is "
                              "no such plug-in"),
                    HasSubstr("left out: the plug-in cannot be loaded: ")));
  EXPECT_EQ(std::ranges::count(listed.err, '\n'), 2);
}

TEST_F(Plugins, TheirKeysAreCheckedAsThoseOfBuiltInOnes) {
  const std::string file = plugin("plugin_example");
  write("c.yaml", std::string(kLog) + "plugins: [" + file +
                      "]\nestimator: {type: sparse_least_squares, tolerence: 1e-3}\n");
  EXPECT_THAT(refusal({"run", "c.yaml"}),
              AllOf(HasSubstr("c.yaml:6: unknown key 'estimator.tolerence'"),
                    HasSubstr("did you mean 'estimator.tolerance'?")));
  write("d.yaml",
        std::string(kLog) + "plugins: [" + file + "]\nestimator: {type: sparse_least_square}\n");
  EXPECT_THAT(refusal({"run", "d.yaml"}), HasSubstr("did you mean 'sparse_least_squares'?"));
}

// And in the process it is the same to the last bit.
TEST_F(Plugins, AStudyHasThemBesideTheOthers) {
  write("s.yaml", std::string(kLog) + "plugins: [" + plugin("plugin_example") +
                      "]\nestimators:\n  - {type: sparse_least_squares}\n"
                      "  - {type: sparse_gauss_newton}\ntrials: 3\n");
  fathom_done({"compare", "s.yaml", "--out", "isolated"});
  fathom_done({"compare", "s.yaml", "--out", "within", "--set", "isolation=none"});
  const auto of = [&](const std::string& folder, const std::string& estimator) {
    std::vector<std::map<std::string, double>> metrics;
    for (const RunRecord& run : ResultStore::open(path(folder)).runs()) {
      if (run.key.estimator != estimator) continue;
      metrics.push_back(run.metrics);
      EXPECT_EQ(run.outcome, "converged") << run.fault;
      std::erase_if(metrics.back(), [](const auto& one) { return is_cost_metric(one.first); });
    }
    return metrics;
  };
  const auto isolated = of("isolated", "sparse_least_squares");
  ASSERT_EQ(isolated.size(), 3u);
  EXPECT_EQ(isolated, of("within", "sparse_least_squares"));
  const auto built_in = of("isolated", "sparse_gauss_newton");
  for (std::size_t k = 0; k < 3; ++k) {
    EXPECT_NEAR(isolated[k].at("chi2"), built_in[k].at("chi2"), 1e-6 * built_in[k].at("chi2"));
    EXPECT_NEAR(isolated[k].at("anees"), built_in[k].at("anees"), 1e-4);
  }
}

TEST_F(Plugins, APlugInThatChangedIsAnotherStudy) {
  fs::copy(plugin("plugin_example"), path("mine.so"));
  write("s.yaml",
        std::string(kLog) + "plugins: [mine.so]\nestimators: [{type: sparse_least_squares}]\n");
  fathom_done({"compare", "s.yaml", "--out", "study"});
  std::ofstream(path("mine.so"), std::ios::app) << "rebuilt";
  EXPECT_THAT(fathom({"compare", "s.yaml", "--out", "study"}).err, HasSubstr("mine.so"));
}

// The example keeps the contract; one that does what none may is found out, and nothing else ends.
TEST_F(Plugins, AreHeldAgainstTheContract) {
  const Ended example =
      fathom({"conformance", "sparse_least_squares", "--plugin", plugin("plugin_example")});
  EXPECT_EQ(example.status, 0) << example.out;
  const Ended other = fathom({"conformance", "misbehaving", "--plugin", plugin("misbehaving")});
  EXPECT_EQ(other.status, 1);
  EXPECT_THAT(other.out, HasSubstr("misbehaving: breaks "));
}

}  // namespace
}  // namespace fathom::test

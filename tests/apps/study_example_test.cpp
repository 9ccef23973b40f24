// The folders of one trial that a study writes beside its store.

#include "apps/command_line.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom::test {
namespace {

constexpr const char* kExampleStudy = R"(
dataset:
  type: simulated
  world: {metres_per_pixel: 0.01}
  mission: {type: sweep, legs: 2, leg_length_m: 3, leg_spacing_m: 1}
  camera: {width: 200, height: 150, fx: 150, fy: 150}
front_end:
  keyframes: {separation_frames: 3}
  ransac: {max_error_m: 0.05}
)";

using StudyExample = CommandLine;

// Cost included, whether the session ran the example itself or found it in the store.
TEST_F(StudyExample, IsTheRunThatWasStored) {
  for (const std::string mode : {"own", "shared"}) {
    const std::string out = "out_" + mode;
    const Arguments command{"compare",  write("study.yaml", kExampleStudy),
                            "--set",    "association.mode=" + mode,
                            "--trials", "1",
                            "--out",    out,
                            "--quiet"};
    for (const char* const session : {"the first", "one that found the example's runs"}) {
      fathom_done(command);
      const ResultStore store = ResultStore::open(path(out));
      for (const RunRecord& run : store.runs()) {
        if (run.key.cell != 0 || run.key.estimator == "dead_reckoning") continue;
        const RunRecord reckoned = store.run({0, 0, 0, "dead_reckoning"}).value();
        const nlohmann::json written = json_of(out + "/" + run.key.estimator + "/metrics.json");
        EXPECT_TRUE(run.metrics.contains("chi2_gap"));
        const nlohmann::json& of_reckoning = written.at("dead_reckoning");
        EXPECT_TRUE(reckoned.metrics.contains("held_out_loops"));
        // The values differ where each estimator has a log of its own.
        for (const auto& [name, value] : reckoned.metrics) {
          EXPECT_TRUE(of_reckoning.contains(name)) << name << ", session: " << session;
        }
        for (const auto& [name, value] : run.metrics) {
          EXPECT_EQ(written.at(name).get<double>(), value) << name << ", session: " << session;
        }
      }
    }
  }
}

}  // namespace
}  // namespace fathom::test

// A configuration that cannot be used: one line that says where and what would be right.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class BadConfiguration : public CommandLine {
 protected:
  std::string refused(const std::string& text, const Arguments& more = {}) const {
    write("c.yaml", text);
    Arguments arguments{"run", "c.yaml", "--out", "out"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return refusal(arguments);
  }
};

TEST_F(BadConfiguration, IsRefusedAtItsLine) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"sede: 1\n", "c.yaml:1: unknown key 'sede'; did you mean 'seed'?"},
      {"front_end:\n  ransac: {iteration: 5}\n", "did you mean 'front_end.ransac.iterations'?"},
      {"seed: 1\nfront_end: {matching: {ratio: high}}\n",
       "c.yaml:2: front_end.matching.ratio: expected a number"},
      {"\n\nfront_end: {keyframes: {separation_frames: 0}}\n",
       "c.yaml:3: front_end.keyframes.separation_frames: expected a whole number >= 1"},
      {"estimator: {type: efk}\n", "did you mean 'ekf'?"},
      {"dataset: {type: vidio}\n", "expected one of simulated, image_folder, pictures, g2o"},
      {"seed: [1, 2\n", "not YAML: "},
      {"seed: 1\nseed: 1\n", "c.yaml:2: 'seed' is given twice"},
      {"seed:\n", "c.yaml:1: seed: has no value"},
      {"- seed\n", "c.yaml:1: expected a map of keys and values"},
      {"estimators: [{type: ekf}]\n", "a list of estimators is for 'compare'"}};
  for (const auto& [text, message] : cases) {
    const std::string line = refused(text);
    EXPECT_THAT(line, StartsWith("c.yaml:")) << text;
    EXPECT_THAT(line, HasSubstr(message)) << text;
  }
}

TEST_F(BadConfiguration, AnImpossibleSurveyNamesItsKey) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"dataset.altitude.amplitude_m=2.5", "dataset.altitude.amplitude_m: "},
      {"dataset.altitude.base_m=0", "dataset.altitude.base_m: expected a number in m > 0"},
      {"dataset.world.picture=none.jpg", "none.jpg"},
      {"dataset.mission.turn_radius_m=9", "dataset.mission.turn_radius_m"},
      {"dataset.odometry.covariance=[1, 2, 0, 1, 0, 1]", "dataset.odometry.covariance"},
      {"dataset.odometry.sigma_x_m=0", "dataset.odometry."},
      {"dataset.camera.distortion=[9, 9, 9, 9, 9]", "dataset.camera"},
      {"dataset.mission.frame_rate_hz=1e9", "dataset.mission."}};
  for (const auto& [setting, message] : cases) {
    EXPECT_THAT(refused(kSmallSurvey, {"--set", setting}), HasSubstr(message)) << setting;
  }
}

TEST_F(BadConfiguration, AnOverrideIsNamed) {
  EXPECT_THAT(refused(kSmallSurvey, {"--set", "seed"}), StartsWith("--set seed: expected KEY="));
  EXPECT_THAT(refused(kSmallSurvey, {"--set", "seeed=1"}),
              StartsWith("--set seeed=1: unknown key 'seeed'; did you mean 'seed'?"));
  EXPECT_THAT(refused(kSmallSurvey, {"--seed", "-4"}), StartsWith("--seed: expected"));
}

TEST_F(BadConfiguration, SolveTakesItsEstimatorsKeysAlone) {
  write("g.g2o", "EDGE_SE2 0 1 1 0 0 1 0 0 1 0 1\n");
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"--set", "front_end.matching.ratio=1"},
       "('solve' takes estimator.…, seed, and of dataset.… what a graph has)"},
      {{"--set", "estimater.tolerance=1"}, "did you mean 'estimator.tolerance'?"},
      {{"--set", "estimator=ekf"}, "unknown key 'estimator'"},
      {{"--set", "estimator.type=[]"}, "estimator.type: expected a single word"},
      {{"--set", "estimator.los=huber"}, "did you mean 'estimator.loss'?"},
      {{"--set", "seed=x"}, "seed: expected a whole number"},
      {{"--estimator", "efk"}, "did you mean 'ekf'?"},
      {{"--estimator", "ekf", "--set", "estimator.type=ekf"}, "--estimator says it already"},
      {{"--estimator", "ekf", "--mode", "batch"}, "ekf takes a log in its order"},
      {{"--estimator", "ekf", "--init", "file"}, "only a batch solve has a start"},
      {{"--estimator", "sparse_gauss_newton", "--init", "file", "--set", "estimator.start=lago"},
       "would ignore --init file"},
      {{"--init", "file"}, "g.g2o: has no vertices to start from; use --init odometry"},
      {{"--set", "estimator.gate_probability=0.9"}, "gate_probability: a batch solve"},
      {{"--ground-truth", "none.tum"}, "none.tum"}};
  for (auto [arguments, message] : cases) {
    arguments.insert(arguments.begin(), {"solve", "g.g2o", "--out", "out"});
    EXPECT_THAT(refusal(arguments), HasSubstr(message));
  }
}

TEST_F(BadConfiguration, SimulateTakesASimulation) {
  write("c.yaml", "dataset: {type: g2o, path: a.g2o}\n");
  EXPECT_THAT(refusal({"simulate", "c.yaml", "--out", "out"}),
              HasSubstr("dataset.type: 'simulate' takes simulated"));
}

TEST_F(BadConfiguration, CheckFindsTheSame) {
  write("c.yaml", "seed: 1\nfrontend: {matching: {ratio: 1}}\n");
  EXPECT_THAT(refusal({"check", "c.yaml"}), StartsWith("c.yaml:2: unknown key"));
}

}  // namespace
}  // namespace fathom::test

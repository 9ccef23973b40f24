// What a run leaves: its manifest and its folder.

#include "fathom/harness/run_folder.hpp"

#include <filesystem>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "fathom/core/files.hpp"
#include "fathom/core/hash.hpp"
#include "fathom/core/version.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "fathom/harness/manifest.hpp"
#include "fathom/measurements/g2o.hpp"
#include "harness/square_result.hpp"
#include "support/planar.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using nlohmann::json;
using test::evaluated;
using test::expect_no_null;
using test::square;

TEST(Manifest, HoldsWhatMadeTheResult) {
  const Recording recording = square();
  const Result result =
      evaluated(recording, "trajectory_iekf", {{"max_iterations", OptionValue::scalar("3")}});
  const json m =
      json::parse(manifest_json("fathom run x", {{"seed", "7"}, {"a.b", "[1, 2]"}},
                                {{"a.png", "00ff"}}, recording, result, builtin_estimators()));
  expect_no_null(m, "manifest");
  EXPECT_EQ(m.at("fathom"), version());
  EXPECT_EQ(m.at("command_line"), "fathom run x");
  EXPECT_EQ(m.at("configuration").at("seed"), "7");
  EXPECT_EQ(m.at("data").at("files"), 1);
  EXPECT_EQ(m.at("data").at("fingerprint"), fingerprint_text({{"a.png", "00ff"}}));
  EXPECT_NE(m.at("data").at("fingerprint"), fingerprint_text({{"a.png", "00fe"}}));
  EXPECT_EQ(m.at("estimator").at("options").at("max_iterations"), "3");
  for (const OptionDescription& option : builtin_estimators().find("trajectory_iekf").options) {
    EXPECT_TRUE(m.at("estimator").at("options").contains(option.key)) << option.key;
  }
  for (const char* key : {"type", "compiler", "flags", "ceres", "eigen", "opencv"}) {
    EXPECT_FALSE(m.at("build").at(key).get<std::string>().empty()) << key;
  }
  EXPECT_FALSE(m.at("machine").at("cpu").get<std::string>().empty());
  EXPECT_EQ(m.at("measurements_fnv1a64"), hash_text(to_g2o(recording.log)));
}

// Of the reference implementation's list of test vectors (Fowler, Noll, Vo).
TEST(Manifest, TheHashIsFnv1a) {
  EXPECT_EQ(hash_text(""), "cbf29ce484222325");
  EXPECT_EQ(hash_text("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(hash_text("foobar"), "85944171f73967e8");
}

TEST(RunFolder, HoldsTheTrajectoriesAndTheLog) {
  const Recording recording = square();
  const Result result = evaluated(recording);
  const test::TemporaryFolder folder;
  write_run(folder.path(), recording, result, "{}\n");
  const auto trajectory = read_tum(folder / "trajectory.tum");
  const auto frames = read_tum(folder / "frames.tum");
  ASSERT_EQ(trajectory.size(), 8u);
  ASSERT_EQ(frames.size(), 16u);
  for (std::size_t k = 0; k < 8; ++k) {
    const Pose& pose = result.run.trajectory[k];
    EXPECT_EQ(trajectory[k].time_ns, recording.keyframe_times_ns[k]);
    EXPECT_LT(test::distance(trajectory[k].pose, pose), 1e-15);
    EXPECT_LT(test::distance(frames[2 * k].pose, pose), 1e-15);
    EXPECT_LT(test::distance(frames[2 * k + 1].pose, compose(pose, {0.5, 0, 0.1})), 1e-15);
  }
  EXPECT_EQ(read_tum(folder / "ground_truth.tum").size(), 8u);
  EXPECT_EQ(read_tum(folder / "dead_reckoning.tum").size(), 16u);
  EXPECT_EQ(to_g2o(read_g2o(folder / "measurements.g2o")), to_g2o(recording.log));
  EXPECT_EQ(read_file(folder / "metrics.json"), metrics_json(result, recording));
  EXPECT_EQ(read_file(folder / "run.json"), "{}\n");
}

TEST(RunFolder, AGraphWithoutTruthHasNeitherFramesNorTruth) {
  Recording recording = square(false);
  recording.frames.clear();
  recording.frame_dead_reckoning.clear();
  const test::TemporaryFolder folder;
  write_run(folder.path(), recording, evaluated(recording), "{}\n");
  EXPECT_FALSE(std::filesystem::exists(folder / "frames.tum"));
  EXPECT_FALSE(std::filesystem::exists(folder / "ground_truth.tum"));
  EXPECT_EQ(read_tum(folder / "dead_reckoning.tum").size(), 8u);
}

}  // namespace
}  // namespace fathom

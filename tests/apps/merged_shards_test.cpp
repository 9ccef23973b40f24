// What a merged study says and has, and folders that are none.

#include <set>
#include <string>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

class MergedShards : public CommandLine {};

TEST_F(MergedShards, AMistypedFolderIsNotOneThatHasNotBegun) {
  EXPECT_THAT(refusal({"status", "of-2/*"}),
              StartsWith("of-2/*: is not there; expected the folder of a shard or of a study"));
  EXPECT_THAT(refusal({"status", write("s.yaml", "")}),
              StartsWith("s.yaml: is a file; expected the folder"));
}

// Of an estimator that always fails.
TEST_F(MergedShards, WhatLooksWrongIsSaidWhenTheyAreMerged) {
  write("wrong.yaml", R"(
dataset:
  type: simulated
  world: {metres_per_pixel: 0.01}
  mission: {type: sweep, legs: 2, leg_length_m: 3, leg_spacing_m: 1}
  attitude: {both_sigma_rad: 0.003}
  camera: {width: 200, height: 150, fx: 150, fy: 150}
front_end:
  keyframes: {separation_frames: 3}
  ransac: {max_error_m: 0.05}
  covariance: {altitude_sigma_m: 0.005, tilt_sigma_rad: 0.003}
estimators:
  - {type: ekf}
  - {type: command, name: broken, command: "false {input} {output}"}
trials: 2
)");
  const auto run = [&](const Arguments& more) {
    Arguments all{"compare", "wrong.yaml", "--no-mosaic", "--cache", "cache"};
    all.insert(all.end(), more.begin(), more.end());
    return fathom(all);
  };
  const auto warnings = [](const std::string& text) {
    const std::size_t first = text.find("\nwarning: ");
    return first == std::string::npos ? "" : text.substr(first);
  };
  const Ended whole = run({"--out", "whole"});
  EXPECT_EQ(whole.status, 1);
  EXPECT_THAT(whole.out, HasSubstr("\nwarning: broken: "));
  const Ended first = run({"--shard", "1/2", "--out", "s1", "--scratch", "disk"});
  EXPECT_EQ(first.status, 0) << first.err;
  EXPECT_EQ(warnings(first.out), warnings(whole.out));
  EXPECT_EQ(run({"--shard", "2/2", "--out", "s2", "--scratch", "disk"}).status, 0);
  const Ended merged = fathom({"merge", "s1", "s2", "--out", "merged"});
  EXPECT_EQ(merged.status, 1);
  EXPECT_EQ(merged.err, "");
  EXPECT_EQ(warnings(merged.out), warnings(whole.out));
  // And every file of the example.
  std::set<std::string> files;
  std::set<std::string> of_whole;
  for (const std::string& name : tree()) {
    if (name.starts_with("merged/")) files.insert(name.substr(7));
    if (name.starts_with("whole/")) of_whole.insert(name.substr(6));
  }
  EXPECT_EQ(files, of_whole);
  EXPECT_TRUE(of_whole.contains("measurements.shared"));
}

}  // namespace
}  // namespace fathom::test

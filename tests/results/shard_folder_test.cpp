// What folders have of the shards of a study.

#include "fathom/results/shard_folder.hpp"

#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "fathom/core/input_error.hpp"
#include "results/shard_manifest.hpp"
#include "results/stored_runs.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

class ShardFolders : public ::testing::Test {
 protected:
  // One cell, two estimators.
  static StudyDescription one_cell(std::size_t trials) {
    StudyDescription study = test::description();
    study.axes = {};
    study.trials = trials;
    return study;
  }

  // The K-th half of the trials: of them those from `from` to `to`.
  void run(const std::string& name, std::size_t k, std::size_t trials, std::size_t from,
           std::size_t to) const {
    ResultStore store = ResultStore::write(folder_ / name, one_cell(trials),
                                           test::manifest(k, 2, trials, "one", trials, "[0]"));
    for (std::size_t trial = from; trial < to; ++trial) {
      for (const char* estimator : {kDeadReckoning, "iterated", "plain"}) {
        store.add(test::record(0, trial, estimator));
      }
    }
  }

  ShardFolder of(const std::string& name) const {
    return shard_folder(folder_ / name, ResultStore::open(folder_ / name));
  }

  static std::vector<std::string> missing(const std::vector<ShardFolder>& folders) {
    std::vector<std::string> said;
    for (const MissingPart& part : missing_parts(folders, 1)) {
      said.push_back(part.what + " | " + part.command);
    }
    return said;
  }

  test::TemporaryFolder folder_;
};

// Trials of a shard of four are those of another one of eight.
TEST_F(ShardFolders, CountTheTrialsOfTheShardWhicheverSessionMadeThem) {
  run("one", 1, 4, 0, 2);
  run("two", 2, 4, 2, 4);
  EXPECT_EQ(of("two").own(), 4u);
  EXPECT_EQ(of("two").own_done(), 4u);
  run("two", 2, 8, 4, 5);
  const ShardFolder two = of("two");
  EXPECT_EQ(two.own(), 8u);
  EXPECT_EQ(two.own_done(), 2u);
  EXPECT_EQ(two.done.size(), 6u);
  EXPECT_EQ(two.of, 16u);
  // The first has not been told yet: trials 0, 1 are there, and 2, 3, which are its now.
  EXPECT_EQ(runs_asked({of("one"), two}), 16u);
  const std::string second =
      "shard 2/2: 6 of 8 runs | fathom compare s.yaml --shard 2/2 --out shard-2";
  EXPECT_THAT(missing({of("one"), two}),
              ElementsAre(second,
                          "shard 1/2: what is missing of it | fathom compare s.yaml --shard "
                          "1/2 --out shard-1"));
  run("one", 1, 8, 2, 4);
  EXPECT_EQ(of("one").own_done(), 8u);
  EXPECT_THAT(missing({of("one"), two}), ElementsAre(second));
  // Merged: sessions whose runs other ones have are not in it, but all runs are.
  run("two", 2, 8, 5, 8);
  merge_stores({folder_ / "one", folder_ / "two"}, folder_ / "all");
  EXPECT_EQ(of("all").own(), 16u);
  EXPECT_EQ(of("all").own_done(), 16u);
}

TEST_F(ShardFolders, ARunThatIsInAnotherFolderIsNotMissing) {
  run("one", 1, 4, 0, 1);
  run("other", 2, 4, 1, 4);
  EXPECT_EQ(of("other").own_done(), 4u);
  EXPECT_THAT(missing({of("one"), of("other")}),
              ElementsAre("1 run | fathom compare s.yaml --out shard-2"));
  EXPECT_THAT(missing_parts({of("one"), of("other")}, 0), IsEmpty());
}

// Version 0.2.0 wrote no trials into a manifest: what its sessions made is the shard's.
TEST_F(ShardFolders, WithoutTrialsInTheManifestAreCountedBySession) {
  const auto run_old = [&](std::size_t k, std::size_t from, std::size_t to) {
    const std::string name = "old-" + std::to_string(k);
    ResultStore store = ResultStore::write(
        folder_ / name, one_cell(4),
        R"({"command_line": "fathom compare s.yaml --shard )" + std::to_string(k) + "/2 --out " +
            name + R"(", "shard": {"index": )" + std::to_string(k) + R"(, "of": 2, "runs": 4}})");
    for (std::size_t trial = from; trial < to; ++trial) {
      for (const char* estimator : {"iterated", "plain"}) {
        store.add(test::record(0, trial, estimator));
      }
    }
  };
  run_old(1, 0, 2);
  EXPECT_EQ(of("old-1").own(), 4u);
  EXPECT_EQ(of("old-1").own_done(), 4u);
  EXPECT_THAT(missing({of("old-1")}),
              ElementsAre("shard 2/2: all runs | fathom compare s.yaml --shard 2/2 --out old-2"));
  run_old(2, 2, 3);
  EXPECT_THAT(
      missing({of("old-1"), of("old-2")}),
      ElementsAre("shard 2/2: 2 of 4 runs | fathom compare s.yaml --shard 2/2 --out old-2"));
}

// No command of a shard that is named does what both divisions lack.
TEST_F(ShardFolders, OfTwoDivisionsTheStudyItselfIsNamed) {
  run("half", 1, 4, 0, 2);
  ResultStore::write(folder_ / "of fifty", one_cell(4), test::manifest(1, 50, 0, "one", 4, "[0]"))
      .finish();
  EXPECT_THAT(missing({of("of fifty"), of("half")}),
              ElementsAre("1 run | fathom compare s.yaml --out shard-1"));
}

// A folder of the whole study beside shards: what is missing is said once.
TEST_F(ShardFolders, BesideAWholeStudyTheShardsAreNamedAlone) {
  run("two", 2, 4, 2, 4);
  ResultStore store = ResultStore::write(folder_ / "whole", one_cell(4),
                                         R"({"command_line": "fathom compare s.yaml"})");
  store.add(test::record(0, 0, "plain"));
  store.finish();
  EXPECT_THAT(missing({of("whole"), of("two")}),
              ElementsAre("shard 1/2: what is missing of it | fathom compare s.yaml --shard 1/2 "
                          "--out shard-1"));
}

TEST_F(ShardFolders, AreOfOneStudyByConfigurationAndData) {
  run("one", 1, 4, 0, 2);
  run("two", 2, 8, 4, 5);
  StudyDescription other = one_cell(4);
  other.configuration.back().second = "9";
  ResultStore::write(folder_ / "other seed", other, test::manifest(1, 1, 8)).finish();
  other = one_cell(4);
  other.data = {{"1.png", "00"}};
  ResultStore::write(folder_ / "other data", other, "{}").finish();
  const auto studies = by_study({of("one"), of("other seed"), of("two"), of("other data")});
  ASSERT_EQ(studies.size(), 3u);
  EXPECT_EQ(studies[0].size(), 2u);
  EXPECT_EQ(studies[0][1].folder, folder_ / "two");
  EXPECT_EQ(studies[1].front().folder, folder_ / "other seed");
}

TEST(Shards, OfNoPartOfAStudyAreNone) {
  EXPECT_TRUE(shard_plan(test::manifest(3, 7, 12)));
  EXPECT_TRUE(shard_plan(test::manifest(1, 1'000'000, 12)));
  EXPECT_FALSE(shard_plan(test::manifest(1, 1'000'001, 12)));
  EXPECT_FALSE(shard_plan(test::manifest(1, 1'000'000'000'000, 12)));
  EXPECT_FALSE(shard_plan(test::manifest(8, 7, 12)));
  EXPECT_FALSE(shard_plan(R"({"shard": {"index": 1, "of": 2, "runs": 12, "places": [0]}})"));
  EXPECT_FALSE(shard_plan(R"({"shard": {"index": 1, "of": 2}})"));
}

TEST(Shards, AreReadStrictly) {
  EXPECT_EQ(parse_shard("3/7"), (Shard{3, 7}));
  EXPECT_EQ(parse_shard("1/1"), (Shard{1, 1}));
  for (const char* wrong :
       {"", "3", "0/3", "4/3", "-1/3", "a/3", "1/", "/3", "1/3/5", "1.5/3", "1/0", "1/1000001"}) {
    EXPECT_THROW(parse_shard(wrong), InputError) << wrong;
  }
}

TEST(Shards, HaveCommandsOfTheirOwn) {
  const auto command = [](const std::string& line, std::size_t index, std::size_t of,
                          std::size_t other) {
    return command_of({{index, of}, 0, line}, other);
  };
  EXPECT_EQ(command("fathom compare s --shard 3/12 --out r/s-03", 3, 12, 11),
            "fathom compare s --shard 11/12 --out r/s-11");
  EXPECT_EQ(command("fathom compare s --shard=3/12 --out=r/3/", 3, 12, 4),
            "fathom compare s --shard=4/12 --out=r/4");
  EXPECT_EQ(command("fathom compare s --shard 1/2 --out runs/one", 1, 2, 2),
            "fathom compare s --shard 2/2 --out runs/one-2");
  EXPECT_EQ(command("fathom compare s --shard 1/2 --out runs/one", 1, 2, 1),
            "fathom compare s --shard 1/2 --out runs/one");
}

}  // namespace
}  // namespace fathom

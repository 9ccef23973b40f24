// Shards made into one store.

#include "fathom/results/merge.hpp"

#include <algorithm>
#include <fstream>
#include <limits>
#include <string>
#include <vector>

#include <gmock/gmock.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/results/result_store.hpp"
#include "fathom/results/run_index.hpp"
#include "results/shard_manifest.hpp"
#include "results/stored_runs.hpp"
#include "support/killed_process.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using test::description;
using test::manifest;
using test::record;
using test::TemporaryFolder;
using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

// All runs of two cells' worth of estimators, dead reckoning beside them.
std::vector<RunRecord> runs_of_trial(std::size_t trial) {
  std::vector<RunRecord> runs;
  for (std::size_t cell = 0; cell < 6; ++cell) {
    for (const char* estimator : {kDeadReckoning, "iterated", "plain"}) {
      runs.push_back(record(cell, trial, estimator));
      runs.back().metrics["anees"] = 1.0 / (1.0 + static_cast<double>(cell));
    }
  }
  return runs;
}

class Merging : public ::testing::Test {
 protected:
  fs::path write(const std::string& name, const std::vector<RunRecord>& runs,
                 const std::string& manifest_text, const StudyDescription& study = description()) {
    ResultStore store = ResultStore::write(path(name), study, manifest_text);
    for (const RunRecord& run : runs) store.add(run);
    store.finish();
    return path(name);
  }

  fs::path path(const std::string& name) const { return folder_.path() / name; }

  std::string refusal(const std::vector<fs::path>& folders) const {
    try {
      merge_stores(folders, path("merged"));
    } catch (const InputError& error) {
      EXPECT_FALSE(fs::exists(path("merged")));
      return error.what();
    }
    return "merged";
  }

  // All that is stored of every run, series included; cost apart or not.
  static std::string content(const fs::path& folder, bool with_cost = true) {
    const ResultStore store = ResultStore::open(folder);
    std::string text;
    for (const RunRecord& row : store.runs()) {
      const RunRecord run = store.run(row.key).value();
      EXPECT_EQ(run.session, row.session);
      EXPECT_EQ(run.machine, row.machine);
      text += std::to_string(run.key.cell) + run.key.estimator + std::to_string(run.key.trial) +
              run.outcome + run.fault + run.log_hash;
      for (const auto& [name, value] : run.metrics) {
        if (with_cost || name != "total_ms") text += name + std::to_string(value);
      }
      for (const auto& [name, values] : run.series) {
        text += name;
        for (const double value : values) text += " " + std::to_string(value);
      }
      if (with_cost) text += run.machine;
      text += "\n";
    }
    return text;
  }

 private:
  TemporaryFolder folder_;
};

TEST_F(Merging, GivesTheContentOfAnUndividedStudyInAnyOrder) {
  std::vector<RunRecord> all = runs_of_trial(0);
  for (const RunRecord& run : runs_of_trial(1)) all.push_back(run);
  const auto whole = write("whole", all, manifest(1, 1, 24));
  std::vector<fs::path> shards;
  for (std::size_t k = 0; k < 4; ++k) {
    std::vector<RunRecord> own;
    for (std::size_t i = k; i < all.size(); i += 4) own.push_back(all[i]);
    shards.push_back(write("s" + std::to_string(k), own, manifest(k + 1, 4, 6)));
  }
  const MergeSummary summary = merge_stores(shards, path("a"));
  EXPECT_EQ(summary.runs, 24u);
  EXPECT_TRUE(summary.is_complete());
  EXPECT_TRUE(summary.missing.empty());
  EXPECT_EQ(content(path("a")), content(whole));
  std::ranges::reverse(shards);
  merge_stores(shards, path("b"));
  EXPECT_EQ(content(path("b")), content(whole));
  // Piece by piece, each time into what is there.
  for (const fs::path& shard : shards) merge_stores({shard}, path("c"));
  EXPECT_EQ(content(path("c")), content(whole));
  EXPECT_EQ(ResultStore::open(path("a")).manifests(), ResultStore::open(path("c")).manifests());
}

TEST_F(Merging, OfRunsThatSeveralHaveKeepsOneWhateverTheOrder) {
  std::vector<RunRecord> runs = runs_of_trial(0);
  const auto a = write("a", runs, manifest(1, 2, 12, "fast"));
  for (RunRecord& run : runs) {
    run.metrics["total_ms"] = 9.0;
    run.jobs = 1;
  }
  const auto b = write("b", runs, manifest(2, 2, 12, "slow"));
  EXPECT_EQ(merge_stores({a, b}, path("ab")).repeated, 12u);
  EXPECT_EQ(merge_stores({b, a}, path("ba")).machines, 2u);
  EXPECT_EQ(content(path("ab")), content(path("ba")));
  EXPECT_EQ(content(path("ab"), false), content(a, false));
  // Cost and machine are of one and the same session.
  for (const RunRecord& run : ResultStore::open(path("ab")).runs()) {
    EXPECT_EQ(run.metrics.at("total_ms"), run.machine == "fast" ? 3.5 : 9.0);
  }
}

// SQLite's log of a process that was killed in the folder is no part of the store that takes its
// place.
TEST_F(Merging, IntoAFolderOfAKilledRunHasItsRunsToo) {
  test::in_killed_process([&] {
    auto* store = new ResultStore(ResultStore::write(path("merged"), description(), "{}"));
    for (const RunRecord& run : runs_of_trial(0)) store->add(run);
  });
  ASSERT_TRUE(fs::exists(path("merged") / "results.sqlite-wal"));
  const auto a = write("a", runs_of_trial(1), manifest(1, 2, 12));
  EXPECT_EQ(merge_stores({a}, path("merged")).runs, 24u);
  EXPECT_FALSE(fs::exists(path("merged") / "results.sqlite-wal"));
  EXPECT_EQ(ResultStore::open(path("merged")).runs().size(), 36u);
  // Nor is one beside a store that is not there.
  fs::create_directory(path("other"));
  std::ofstream(path("other") / "results.sqlite-wal") << "of another store";
  merge_stores({a}, path("other"));
  EXPECT_FALSE(fs::exists(path("other") / "results.sqlite-wal"));
}

TEST_F(Merging, ARunWithNumbersThatAreNoneIsAlikeToItself) {
  std::vector<RunRecord> runs = runs_of_trial(0);
  runs[4].series["x"][1] = std::numeric_limits<double>::quiet_NaN();
  const auto a = write("a", runs, manifest(1, 2, 12));
  EXPECT_EQ(merge_stores({a}, path("merged")).repeated, 0u);
  EXPECT_EQ(merge_stores({a}, path("merged")).repeated, 12u);
  runs[4].series["x"][1] = 1.0;
  const auto b = write("b", runs, manifest(2, 2, 12));
  EXPECT_THAT([&] { merge_stores({b}, path("merged")); },
              ::testing::ThrowsMessage<InputError>(HasSubstr("series x")));
}

TEST_F(Merging, RefusesAnotherResultOfTheSameRun) {
  std::vector<RunRecord> runs = runs_of_trial(0);
  const auto a = write("a", runs, manifest(1, 2, 12));
  runs[4].metrics["anees"] = 0.25;
  const auto b = write("b", runs, manifest(2, 2, 12));
  EXPECT_THAT(refusal({a, b}),
              AllOf(HasSubstr("shard "), HasSubstr("iterated, trial 0 of survey 0"),
                    HasSubstr("anees"), HasSubstr("0.25"), HasSubstr("run it again")));
  runs = runs_of_trial(0);
  runs[4].series["x"][1] = 0.3333333333333334;
  EXPECT_THAT(refusal({a, write("c", runs, manifest(2, 2, 12))}), HasSubstr("series x"));
  runs = runs_of_trial(0);
  runs[4].outcome = "diverged";
  EXPECT_THAT(refusal({a, write("d", runs, manifest(2, 2, 12))}), HasSubstr("outcome"));
}

TEST_F(Merging, RefusesShardsOfTwoStudies) {
  const auto a = write("a", runs_of_trial(0), manifest(1, 2, 12));
  StudyDescription other = description();
  other.configuration = {{"association.mode", "own"}, {"seed", "2"}};
  const auto b = write("b", {}, manifest(2, 2, 12), other);
  EXPECT_THAT(refusal({a, b}), AllOf(HasSubstr("is of another study"), HasSubstr("seed: "),
                                     HasSubstr("1 "), HasSubstr("2 ")));
  other = description();
  other.data = {{"1.png", "00"}};
  const auto c = write("c", {}, manifest(2, 2, 12), other);
  EXPECT_THAT(refusal({a, c}), HasSubstr("1.png"));
}

TEST_F(Merging, NamesAShardThatIsTornOrMissing) {
  const auto a = write("a", runs_of_trial(0), manifest(1, 2, 12));
  const auto b = write("b", runs_of_trial(1), manifest(2, 2, 12));
  const std::string whole = read_file(b / "results.sqlite");
  std::ofstream(b / "results.sqlite", std::ios::binary) << whole.substr(0, whole.size() / 2);
  EXPECT_THAT(refusal({a, b}), AllOf(HasSubstr("shard " + b.string()), HasSubstr("damaged")));
  std::ofstream(b / "results.sqlite", std::ios::binary | std::ios::trunc).flush();
  EXPECT_THAT(refusal({a, b}), HasSubstr("shard " + b.string()));
  EXPECT_THAT(refusal({a, path("nowhere")}),
              AllOf(HasSubstr("shard " + path("nowhere").string()), HasSubstr("no results")));
  // A bit that flipped in a series, which SQLite does not see.
  std::string flipped = whole;
  const double third = 1.0 / 3.0;
  const std::string bytes(reinterpret_cast<const char*>(&third), sizeof third);
  const std::size_t at = flipped.find(bytes);
  ASSERT_NE(at, std::string::npos);
  flipped[at] = static_cast<char>(flipped[at] ^ 1);
  std::ofstream(b / "results.sqlite", std::ios::binary | std::ios::trunc) << flipped;
  EXPECT_THAT(refusal({a, b}), HasSubstr("checksum differs"));
}

TEST_F(Merging, ListsWhatIsMissingWithItsCommand) {
  std::vector<RunRecord> some;  // three trials of the first shard's four: six runs of estimators
  for (const std::size_t trial : {0u, 1u}) {
    for (const RunRecord& run : runs_of_trial(trial)) {
      if (run.key.cell + trial < 2) some.push_back(run);
    }
  }
  const auto a = write("a", some, manifest(1, 3, 8));
  const auto b = write("b", {}, manifest(3, 3, 8));
  const MergeSummary summary = merge_stores({a, b}, path("merged"));
  EXPECT_FALSE(summary.is_complete());
  EXPECT_EQ(summary.runs, 6u);
  EXPECT_EQ(summary.of, 24u);
  std::vector<std::string> said;
  for (const MissingPart& part : summary.missing) said.push_back(part.what + " | " + part.command);
  EXPECT_THAT(said, ElementsAre("shard 1/3: 2 of 8 runs | fathom compare s.yaml --shard 1/3 --out "
                                "shard-1",
                                "shard 3/3: 8 of 8 runs | fathom compare s.yaml --shard 3/3 --out "
                                "shard-3",
                                "shard 2/3: all runs | fathom compare s.yaml --shard 2/3 --out "
                                "shard-2"));
}

TEST_F(Merging, OfAStoreThatWasNotDividedSaysItsCommand) {
  const auto a = write("a", runs_of_trial(0), R"({"command_line": "fathom compare s.yaml"})");
  const MergeSummary summary = merge_stores({a}, path("merged"));
  ASSERT_EQ(summary.missing.size(), 1u);
  EXPECT_EQ(summary.missing[0].what, a.string() + ": 12 of 24 runs");
  EXPECT_EQ(summary.missing[0].command, "fathom compare s.yaml");
}

}  // namespace
}  // namespace fathom

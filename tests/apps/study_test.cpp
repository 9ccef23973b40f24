// Studies through the real command line.

#include <csignal>
#include <map>
#include <random>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "apps/study_content.hpp"
#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;

class Studies : public CommandLine {
 protected:
  /// Runs a trial: those of the program, and dead reckoning.
  const std::size_t estimators_ = builtin_estimators().entries().size() + 1;

  std::size_t runs_in(const std::string& folder) const {
    return ResultStore::open(path(folder)).runs().size();
  }

  /// Of a study at work, whose store may not be complete yet.
  bool has_runs(const std::string& folder) const {
    try {
      return runs_in(folder) > 0;
    } catch (const InputError&) {
      return false;
    }
  }
};

TEST_F(Studies, TheNumberOfJobsDoesNotMatterNorDoesTheCache) {
  write("s.yaml", kStudy);
  fathom_done({"compare", "s.yaml", "--out", "one", "--cache", "cache"});
  fathom_done({"compare", "s.yaml", "--out", "two", "--cache", "cache", "--jobs", "2"});
  fathom_done({"compare", "s.yaml", "--out", "none", "--no-cache", "--jobs", "64"});
  EXPECT_EQ(runs_in("one"), 2u * 5u * estimators_);
  // Said is what was at work: 2 cells of 5 trials give work to 10.
  for (const RunRecord& run : ResultStore::open(path("none")).runs()) EXPECT_EQ(run.jobs, 10);
  EXPECT_EQ(content(path("one")), content(path("two")));
  EXPECT_EQ(content(path("one")), content(path("none")));
  // The page of a study without a title has that of its folder.
  EXPECT_THAT(read_file(path("one/report.html")), HasSubstr("<title>one</title>"));
}

// Between any two writes of a database, its own or that of the registrations.
TEST_F(Studies, KilledAgainAndAgainItEndsAsAnUndisturbedOneDoes) {
  if (std::string(FATHOM_TEST_PRELOADED).empty()) GTEST_SKIP() << "not with a sanitizer";
  write("s.yaml", kStudy);
  fathom_done({"compare", "s.yaml", "--out", "whole", "--cache", "a", "--trials", "20"});
  std::mt19937 random(7);
  for (int i = 0; i < 12; ++i) {
    // Early, when the stores are made, and anywhere later.
    const std::size_t write = i < 4 ? 5 * i + 1 : 20 + random() % 60;
    surroundings_.environment = {{"LD_PRELOAD", FATHOM_TEST_PRELOADED},
                                 {"FATHOM_KILL_AT_WRITE", std::to_string(write)}};
    const Ended ended =
        fathom({"compare", "s.yaml", "--out", "killed", "--cache", "b", "--trials", "20"});
    EXPECT_EQ(ended.status, 128 + SIGKILL) << "at write " << write;
  }
  surroundings_ = {};
  fathom_done({"compare", "s.yaml", "--out", "killed", "--cache", "b", "--trials", "20"});
  EXPECT_EQ(content(path("whole")), content(path("killed")));
}

// Its estimates are dead reckoning, and somebody who set the reach too short must see it.
TEST_F(Studies, RunsWithoutLoopsSayIt) {
  write("s.yaml",
        "dataset:\n  type: simulated_log\n  loops: {max_distance_m: 0.001}\n"
        "estimators:\n  - {type: ekf}\ntrials: 2\n");
  EXPECT_THAT(fathom_done({"compare", "s.yaml", "--out", "one"}).out,
              HasSubstr("2/2 done, 2 without loops"));
}

TEST_F(Studies, InterruptedItSaysHowToGoOn) {
  write("s.yaml", kStudy);
  bool is_asked = false;
  const Ended ended =
      fathom({"compare", "s.yaml", "--out", "out", "--trials", "2000"}, [&](pid_t process) {
        if (is_asked || !has_runs("out")) return;
        is_asked = true;
        ::kill(process, SIGINT);
      });
  EXPECT_EQ(ended.status, 130);
  EXPECT_THAT(ended.err, HasSubstr("The same command goes on from there."));
  EXPECT_FALSE(fs::exists(path("out/report.html")));
}

// Their files have names in common.
TEST_F(Studies, ARunAndAStudyKeepApart) {
  write("log.yaml", "dataset: {type: simulated_log}\nestimator: {type: ekf}\n");
  write("s.yaml", "dataset: {type: simulated_log}\nestimators: [{type: ekf}]\n");
  write("square.g2o", square_graph(40, 3));
  fathom_done({"run", "log.yaml", "--out", "run"});
  fathom_done({"compare", "s.yaml", "--out", "study"});
  const std::string metrics = read_file(path("study/metrics.json"));
  const std::string holds_study =
      "fathom: error: study: holds a study; a run needs a folder of its own (--out)\n";
  EXPECT_EQ(fathom({"run", "log.yaml", "--out", "study"}).err, holds_study);
  EXPECT_EQ(fathom({"solve", "square.g2o", "--out", "study"}).err, holds_study);
  EXPECT_EQ(read_file(path("study/metrics.json")), metrics);
  EXPECT_EQ(fathom({"compare", "s.yaml", "--out", "run"}).err,
            "fathom: error: run: holds a run; a study needs a folder of its own (--out)\n");
  EXPECT_FALSE(fs::exists(path("run/results.sqlite")));
}

// Old and new data never meet in one mean.
TEST_F(Studies, OtherDataAreRefusedByTheNameOfTheFile) {
  write("s.yaml", kStudy);
  fathom_done({"simulate", "s.yaml", "--out", "data"});
  write("f.yaml",
        "dataset: {type: image_folder, path: data}\nfront_end: {keyframes: {separation_frames: 3}, "
        "candidates: {max_distance_m: 1.6}}\nestimators: [{type: ekf}]\n");
  const Arguments again{"compare", "f.yaml", "--out", "out", "--no-cache", "--no-mosaic"};
  fathom_done(again);
  fathom_done(again);
  const auto pictures = path("data/mav0/cam0/data");
  std::vector<fs::path> files(fs::directory_iterator(pictures), {});
  std::sort(files.begin(), files.end());
  fs::copy_file(files[0], path("kept.png"));
  fs::copy_file(files[1], files[0], fs::copy_options::overwrite_existing);
  EXPECT_THAT(refusal(again), AllOf(HasSubstr("holds results of other data ("),
                                    HasSubstr(files[0].filename().string() + " has changed")));
  fs::copy_file(path("kept.png"), files[0], fs::copy_options::overwrite_existing);
  fathom_done(again);
  // The last row of a table cut off.
  const std::string csv = "data/mav0/state_groundtruth_estimate0/data.csv";
  std::string text = read_file(path(csv));
  text.erase(text.rfind('\n', text.size() - 2) + 1);
  write(csv, text);
  EXPECT_THAT(refusal(again), HasSubstr("state_groundtruth_estimate0/data.csv has changed"));
}

TEST_F(Studies, JobsAreThoseThatCanBeAtWork) {
  write("s.yaml", kStudy);
  fathom_done({"compare", "s.yaml", "--out", "out", "--trials", "1", "--jobs", "1000"});
  const ResultStore store = ResultStore::open(path("out"));
  const int trials = static_cast<int>(store.study().cell_count());
  for (const RunRecord& run : store.runs()) EXPECT_EQ(run.jobs, trials);
  EXPECT_THAT(store.manifests().front(), HasSubstr("\"jobs\": " + std::to_string(trials)));
}

TEST_F(Studies, MoreTrialsAreAddedToWhatIsThere) {
  write("s.yaml", kStudy);
  fathom_done({"compare", "s.yaml", "--out", "out", "--trials", "2"});
  const std::string before = content(path("out"));
  fathom_done({"compare", "s.yaml", "--out", "out"});
  fathom_done({"compare", "s.yaml", "--out", "other"});
  EXPECT_EQ(runs_in("out"), 2u * 5u * estimators_);
  EXPECT_EQ(content(path("out")), content(path("other")));
  EXPECT_NE(content(path("out")), before);
}

TEST_F(Studies, AnotherConfigurationIsRefusedWithWhatDiffers) {
  write("s.yaml", kStudy);
  fathom_done({"compare", "s.yaml", "--out", "out", "--trials", "1"});
  EXPECT_THAT(refusal({"compare", "s.yaml", "--out", "out", "--trials", "1", "--set",
                       "front_end.ransac.max_error_m=0.06"}),
              HasSubstr("front_end.ransac.max_error_m: 0.05 there, 0.06 here"));
}

TEST_F(Studies, EveryEstimatorOfATrialSeesTheSameDraws) {
  write("s.yaml", std::string(kStudy) + "estimators: [{type: ekf}, {type: ekf, name: again}]\n");
  fathom_done({"compare", "s.yaml", "--out", "out"});
  const ResultStore store = ResultStore::open(path("out"));
  for (const RunRecord& run : store.runs()) {
    if (run.key.estimator != "again") continue;
    const RunKey other{run.key.cell, run.key.survey, run.key.trial, "ekf"};
    EXPECT_EQ(store.series(run.key, "x_m"), store.series(other, "x_m"));
    const RunKey next{run.key.cell, run.key.survey, (run.key.trial + 1) % 5, "ekf"};
    EXPECT_NE(store.series(run.key, "x_m"), store.series(next, "x_m"));
  }
}

TEST_F(Studies, SharedAssociationGivesOneLogToAll) {
  write("s.yaml", kStudy);
  fathom_done({"compare", "s.yaml", "--out", "out", "--set", "association.mode=shared"});
  std::map<std::pair<std::size_t, std::size_t>, std::set<std::string>> hashes;
  for (const RunRecord& run : ResultStore::open(path("out")).runs()) {
    if (run.key.estimator == kDeadReckoning) continue;
    hashes[{run.key.cell, run.key.trial}].insert(run.log_hash);
  }
  EXPECT_EQ(hashes.size(), 10u);
  std::set<std::string> all;
  for (const auto& [trial, own] : hashes) {
    EXPECT_EQ(own.size(), 1u);
    all.insert(own.begin(), own.end());
  }
  EXPECT_EQ(all.size(), 10u);
}

TEST_F(Studies, DrawnLogsDifferByTrialAndCell) {
  write("s.yaml",
        "dataset: {type: simulated_log, mission: {legs: 2}}\nestimators: [{type: ekf}]\n"
        "sweep: [{key: dataset.loops.scale_error, name: scale, values: [0, 0.2]}]\n"
        "trials: 3\njobs: 2\n");
  fathom_done({"compare", "s.yaml", "--out", "out"});
  std::set<std::string> logs;
  std::map<std::size_t, double> sums;
  for (const RunRecord& run : ResultStore::open(path("out")).runs()) {
    if (run.key.estimator == kDeadReckoning) continue;
    logs.insert(run.log_hash);
    sums[run.key.cell] += run.metrics.at("mean_position_error_m");
  }
  EXPECT_EQ(logs.size(), 6u);
  EXPECT_NE(sums[0], sums[1]);
}

TEST_F(Studies, ADataSetThatFailsLeavesNothingBehind) {
  write("s.yaml", "dataset: {type: image_folder, path: nowhere}\nestimators: [{type: ekf}]\n");
  EXPECT_THAT(refusal({"compare", "s.yaml", "--out", "out"}), HasSubstr("nowhere"));
}

}  // namespace
}  // namespace fathom::test

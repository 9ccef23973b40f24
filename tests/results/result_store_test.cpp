#include "fathom/results/result_store.hpp"

#include <fstream>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "results/stored_runs.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using test::description;
using test::input_error_of;
using test::record;
using test::TemporaryFolder;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

TEST(StudyDescription, CellsAreTheProductOfTheAxesTheLastRunningFastest) {
  const StudyDescription study = description();
  EXPECT_EQ(study.cell_count(), 6u);
  EXPECT_THAT(study.places_of(0), ElementsAre(0, 0));
  EXPECT_THAT(study.places_of(2), ElementsAre(0, 2));
  EXPECT_THAT(study.places_of(3), ElementsAre(1, 0));
  EXPECT_EQ(study.label_of(5), "separation 10, noise high");
  EXPECT_EQ(study.association_of(5), "own");
  EXPECT_EQ(StudyDescription{}.cell_count(), 1u);
  EXPECT_EQ(StudyDescription{}.label_of(0), "all");
}

TEST(StudyDescription, AssociationMayBeAnAxis) {
  StudyDescription study = description();
  study.axes.push_back({"association", "association.mode", {"own", "shared"}});
  EXPECT_EQ(study.association_of(0), "own");
  EXPECT_EQ(study.association_of(1), "shared");
}

TEST(StudyDescription, ASweptKeyIsKnownByItsValueNotByItsLabel) {
  StudyDescription study = description();
  EXPECT_EQ(study.alignment_of(5), "origin");
  study.axes.push_back(
      {"alignment", "evaluation.alignment", {"as it is", "best fit"}, {"none", "se2"}});
  EXPECT_EQ(study.alignment_of(0), "none");
  EXPECT_EQ(study.alignment_of(1), "se2");
}

TEST(ResultStore, GivesBackWhatWasStored) {
  const TemporaryFolder folder;
  {
    ResultStore store = ResultStore::write(folder.path(), description(), "{\"a\": 1}");
    store.add(record(3, 1, "plain"));
    store.add(record(3, 1, kDeadReckoning));
    store.add(record(0, 0, "iterated"));
    store.finish();
  }
  const ResultStore store = ResultStore::open(folder.path());
  const StudyDescription study = store.study();
  EXPECT_EQ(study.title, "two by three");
  EXPECT_EQ(study.alignment, "origin");
  EXPECT_EQ(study.surveys, 1u);
  EXPECT_EQ(study.trials, 2u);
  ASSERT_EQ(study.axes.size(), 2u);
  EXPECT_EQ(study.axes[1].key, "dataset.odometry.covariance");
  EXPECT_THAT(study.axes[1].labels, ElementsAre("none", "low", "high"));
  ASSERT_EQ(study.estimators.size(), 2u);
  EXPECT_EQ(study.estimators[0].name, "iterated");
  EXPECT_EQ(study.estimators[1].type, "ekf");
  EXPECT_THAT(study.metrics, ElementsAre("mean_position_error_m", "anees"));
  EXPECT_EQ(study.configuration, description().configuration);
  EXPECT_THAT(store.manifests(), ElementsAre("{\"a\": 1}"));

  const std::vector<RunRecord> runs = store.runs();
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].key, (RunKey{0, 0, 0, "iterated"}));
  EXPECT_EQ(runs[1].key, (RunKey{3, 0, 1, kDeadReckoning}));
  EXPECT_EQ(runs[2].key, (RunKey{3, 0, 1, "plain"}));
  EXPECT_EQ(runs[2].outcome, "converged");
  EXPECT_EQ(runs[2].log_hash, "00ff");
  EXPECT_EQ(runs[2].jobs, 2);
  EXPECT_EQ(runs[2].metrics, record(3, 1, "plain").metrics);
  EXPECT_EQ(store.series({3, 0, 1, "plain"}, "x"), record(0, 0, "").series.at("x"));
  EXPECT_EQ(store.series({3, 0, 1, "plain"}, "empty"), std::vector<double>{});
  EXPECT_FALSE(store.series({3, 0, 1, "plain"}, "y"));
  EXPECT_FALSE(store.series({3, 0, 0, "plain"}, "x"));
}

TEST(ResultStore, GoesOnWithWhatIsThere) {
  const TemporaryFolder folder;
  { ResultStore::write(folder.path(), description(), "first").add(record(0, 0, "plain")); }
  StudyDescription more = description();
  more.surveys = 3;
  more.trials = 7;
  more.title = "another title";
  ResultStore store = ResultStore::write(folder.path(), more, "second");
  ASSERT_EQ(store.runs().size(), 1u);
  EXPECT_EQ(store.runs()[0].key, (RunKey{0, 0, 0, "plain"}));
  EXPECT_THAT(store.manifests(), ElementsAre("first", "second"));
  EXPECT_EQ(store.study().surveys, 3u);
  EXPECT_EQ(store.study().trials, 7u);
  EXPECT_EQ(store.study().title, "another title");
  RunRecord other = record(0, 0, "plain");
  other.metrics["mean_position_error_m"] = 99.0;
  store.add(other);
  EXPECT_EQ(store.runs().front().metrics.at("mean_position_error_m"), 0.1);
}

TEST(ResultStore, LabelsAndNamesOfAnAxisMayChangeAfterwards) {
  const TemporaryFolder folder;
  { ResultStore::write(folder.path(), description(), "").add(record(5, 0, "plain")); }
  StudyDescription other = description();
  other.axes[1].name = "odometry";
  other.axes[1].values = other.axes[1].labels;
  other.axes[1].labels[2] = "awful";
  {
    ResultStore store = ResultStore::write(folder.path(), other, "");
    EXPECT_EQ(store.study().label_of(5), "separation 10, odometry awful");
    store.finish();
  }
  const ResultStore store = ResultStore::open(folder.path());
  EXPECT_EQ(store.study().label_of(5), "separation 10, odometry awful");
  EXPECT_EQ(store.study().axes[1].values[2], "high");
  EXPECT_EQ(store.runs().size(), 1u);
}

TEST(ResultStore, AChangedConfigurationIsRefusedWithWhatDiffers) {
  const TemporaryFolder folder;
  { ResultStore::write(folder.path(), description(), ""); }
  StudyDescription other = description();
  other.configuration = {{"association.mode", "own"}, {"seed", "2"}, {"new.key", "x"}};
  EXPECT_THAT(input_error_of([&] { ResultStore::write(folder.path(), other, ""); }),
              HasSubstr("another configuration (seed: 1 there, 2 here; new.key: absent there, x "
                        "here); use another --out"));
  for (int i = 0; i < 60; ++i) other.configuration.emplace_back("key." + std::to_string(i), "x");
  EXPECT_THAT(input_error_of([&] { ResultStore::write(folder.path(), other, ""); }),
              ::testing::AllOf(HasSubstr("(seed: 1 there, 2 here; key.0: "),
                               HasSubstr("; and 56 more); use another --out")));
}

TEST(ResultStore, OneProcessWritesAtATime) {
  const TemporaryFolder folder;
  const ResultStore store = ResultStore::write(folder.path(), description(), "");
  EXPECT_THAT(input_error_of([&] { ResultStore::write(folder.path(), description(), ""); }),
              HasSubstr("another process is at work on this study"));
}

TEST(ResultStore, AFinishedStudyOpensFromAReadOnlyFolder) {
  const TemporaryFolder folder;
  {
    ResultStore store = ResultStore::write(folder.path(), description(), "");
    store.add(record(0, 0, "plain"));
    store.finish();
  }
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder.path())) {
    names.push_back(entry.path().filename());
  }
  EXPECT_THAT(names, ElementsAre("results.sqlite"));
  fs::permissions(folder.path(), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_EQ(ResultStore::open(folder.path()).runs().size(), 1u);
  fs::permissions(folder.path(), fs::perms::owner_all);
}

TEST(ResultStore, SeveralThreadsMayAdd) {
  const TemporaryFolder folder;
  ResultStore store = ResultStore::write(folder.path(), description(), "");
  const auto add = [&store](const std::string& estimator) {
    for (std::size_t cell = 0; cell < 6; ++cell) {
      for (std::size_t trial = 0; trial < 10; ++trial) store.add(record(cell, trial, estimator));
    }
  };
  std::thread other(add, "iterated");
  add("plain");
  other.join();
  EXPECT_EQ(store.runs().size(), 120u);
}

TEST(ResultStore, RefusesWhatIsNoStore) {
  const TemporaryFolder folder;
  EXPECT_THAT(input_error_of([&] { ResultStore::open(folder.path()); }),
              HasSubstr("there are no results; 'fathom compare' writes them"));
  const fs::path file = folder / "results.sqlite";
  std::ofstream(file) << "these are no results, however long they may be, of any study at all\n";
  EXPECT_THAT(input_error_of([&] { ResultStore::open(file); }), HasSubstr("is no result store"));
  EXPECT_THAT(input_error_of([&] { ResultStore::write(folder.path(), description(), ""); }),
              HasSubstr("is no result store"));
}

TEST(ResultStore, RefusesToMixData) {
  const test::TemporaryFolder folder;
  StudyDescription study = description();
  study.data = {{"d/1.png", "aa"}, {"d/2.png", "bb"}, {"d/data.csv", "cc"}};
  ResultStore::write(folder.path(), study, "{}").add(record(0, 0, "plain"));
  EXPECT_NO_THROW(ResultStore::write(folder.path(), study, "{}"));
  EXPECT_EQ(ResultStore::open(folder.path()).study().data, study.data);
  const auto refused = [&](const std::vector<std::pair<std::string, std::string>>& data) {
    study.data = data;
    return input_error_of([&] { ResultStore::write(folder.path(), study, "{}"); });
  };
  EXPECT_THAT(refused({{"d/1.png", "aa"}, {"d/2.png", "b0"}, {"d/data.csv", "cc"}}),
              HasSubstr("holds results of other data (d/2.png has changed)"));
  EXPECT_THAT(refused({{"d/1.png", "aa"}, {"d/data.csv", "cc"}, {"d/3.png", "dd"}}),
              HasSubstr("(d/3.png is new; d/2.png is gone)"));
  EXPECT_THAT(refused({}), HasSubstr("d/1.png is gone; d/2.png is gone; d/data.csv is gone"));
  EXPECT_THAT(refused({{"1", "a"}, {"2", "b"}}), HasSubstr("; and 2 more"));
}

TEST(ResultStore, LabelsMayChange) {
  const test::TemporaryFolder folder;
  StudyDescription study = description();
  ResultStore::write(folder.path(), study, "{}").add(record(1, 0, "plain"));
  study.axes[1].name = "drift";
  study.axes[1].labels = {"calm", "some", "much"};
  ResultStore::write(folder.path(), study, "{}");
  const ResultStore store = ResultStore::open(folder.path());
  EXPECT_EQ(store.study().label_of(1), "separation 5, drift some");
  EXPECT_EQ(store.runs().size(), 1u);
}

TEST(ResultStore, KeepsWhatAFaultyEstimatorDid) {
  const test::TemporaryFolder folder;
  RunRecord run = record(0, 0, "plain");
  run.outcome = "numerical_failure";
  run.fault = "update at keyframe 4: it's \"wrong\"";
  ResultStore::write(folder.path(), description(), "{}").add(run);
  EXPECT_EQ(ResultStore::open(folder.path()).runs().front().fault, run.fault);
}

}  // namespace
}  // namespace fathom

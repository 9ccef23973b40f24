// Surveys in a store.

#include <vector>

#include <gtest/gtest.h>

#include "results/stored_runs.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::description;
using test::record;
using test::TemporaryFolder;

TEST(ResultStore, TellsSurveysApart) {
  const TemporaryFolder folder;
  StudyDescription study = description();
  study.surveys = 2;
  {
    ResultStore store = ResultStore::write(folder.path(), study, "");
    RunRecord run = record(0, 1, "plain");
    store.add(run);
    run.key.survey = 1;
    run.series["x"] = {7.0};
    store.add(run);
    run.key.trial = 0;
    store.add(run);
    store.finish();
  }
  // Fewer of either leave the study as large as it is.
  ResultStore::write(folder.path(), description(), "");
  const ResultStore store = ResultStore::open(folder.path());
  EXPECT_EQ(store.study().surveys, 2u);
  const std::vector<RunRecord> runs = store.runs();
  ASSERT_EQ(runs.size(), 3u);
  EXPECT_EQ(runs[0].key, (RunKey{0, 0, 1, "plain"}));
  EXPECT_EQ(runs[1].key, (RunKey{0, 1, 0, "plain"}));
  EXPECT_EQ(runs[2].key, (RunKey{0, 1, 1, "plain"}));
  EXPECT_EQ(store.series({0, 1, 1, "plain"}, "x"), std::vector<double>{7.0});
  EXPECT_NE(store.series({0, 0, 1, "plain"}, "x"), std::vector<double>{7.0});
}

}  // namespace
}  // namespace fathom

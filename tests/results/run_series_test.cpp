#include "fathom/results/run_series.hpp"

#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/input_error.hpp"
#include "results/stored_runs.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Optional;

class RunSeriesOfAStore : public ::testing::Test {
 protected:
  void write(const RunRecord& run) {
    ResultStore store = ResultStore::write(folder_.path(), description(), "{}");
    store.add(run);
    store.finish();
  }
  ResultStore opened() const { return ResultStore::open(folder_.path()); }

  RunRecord run_ = record(0, 0, "plain");
  TemporaryFolder folder_;
};

TEST_F(RunSeriesOfAStore, AreReadAsTheyWerePut) {
  put(run_, series::loop_from, std::vector<std::size_t>{0, 7});
  put(run_, series::loop_fate, std::vector<LoopFate>{LoopFate::lost, LoopFate::used});
  put(run_, series::loop_nis, std::vector<std::optional<double>>{std::nullopt, 2.5});
  append(run_, series::x_m, -1.0);
  put(run_, series::update_ms, {});
  write(run_);
  // Of numbers without a sign −1 is none; a coordinate of −1 is one.
  EXPECT_THAT(run_.series.at("loop_nis"), ElementsAre(-1.0, 2.5));
  const ResultStore store = opened();
  EXPECT_THAT(series_of(store, run_.key, series::loop_from), Optional(ElementsAre(0u, 7u)));
  EXPECT_THAT(series_of(store, run_.key, series::loop_fate),
              Optional(ElementsAre(LoopFate::lost, LoopFate::used)));
  EXPECT_THAT(series_of(store, run_.key, series::loop_nis),
              Optional(ElementsAre(std::nullopt, 2.5)));
  EXPECT_THAT(series_of(store, run_.key, series::x_m), Optional(ElementsAre(-1.0)));
  EXPECT_THAT(series_of(store, run_.key, series::update_ms), Optional(ElementsAre()));
  EXPECT_EQ(series_of(store, run_.key, series::y_m), std::nullopt);
}

TEST_F(RunSeriesOfAStore, EntriesOfAnotherTypeAreRefused) {
  run_.series["loop_fate"] = {0.0, 3.0};
  run_.series["loop_from"] = {1.5};
  run_.series["loop_to"] = {-1.0};
  run_.series["update_keyframe"] = {std::numeric_limits<double>::infinity()};
  write(run_);
  const ResultStore store = opened();
  try {
    series_of(store, run_.key, series::loop_fate);
    FAIL() << "3 is no fate";
  } catch (const InputError& error) {
    EXPECT_THAT(error.what(), HasSubstr("series loop_fate of plain has an entry of 3, which"));
  }
  EXPECT_THROW(series_of(store, run_.key, series::loop_from), InputError);
  EXPECT_THROW(series_of(store, run_.key, series::loop_to), InputError);
  EXPECT_THROW(series_of(store, run_.key, series::update_keyframe), InputError);
}

}  // namespace
}  // namespace fathom::test

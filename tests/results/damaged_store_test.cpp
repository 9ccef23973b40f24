// A store that is not what was written: bits flipped on disk, or somebody's edits.

#include <SQLiteCpp/SQLiteCpp.h>
#include <atomic>
#include <thread>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"
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
using ::testing::HasSubstr;

// Runs a statement on a finished store, as a flipped bit or an editor would.
void damage(const fs::path& folder, const std::string& statement) {
  SQLite::Database database((folder / "results.sqlite").string(), SQLite::OPEN_READWRITE);
  ASSERT_EQ(database.exec(statement), 1) << statement;
}

class DamagedStoreBy : public testing::TestWithParam<const char*> {};

TEST_P(DamagedStoreBy, IsRefusedByRunAndFile) {
  const TemporaryFolder folder;
  {
    ResultStore store = ResultStore::write(folder.path(), description(), "");
    store.add(record(3, 0, "iterated"));
    store.add(record(3, 1, "plain"));
    store.finish();
  }
  damage(folder.path(), GetParam());
  const auto names_the_file = HasSubstr((folder / "results.sqlite").string() + ": is damaged: ");
  EXPECT_THAT(input_error_of([&] { ResultStore::open(folder.path()); }), names_the_file);
  EXPECT_THAT(input_error_of([&] { ResultStore::write(folder.path(), description(), ""); }),
              names_the_file);
}

INSTANTIATE_TEST_SUITE_P(
    OneThing, DamagedStoreBy,
    testing::Values(
        "UPDATE value SET value = value + 1e-9 WHERE run = 1 AND metric = 1",
        "UPDATE value SET metric = 7 WHERE run = 1 AND metric = 1",
        "DELETE FROM value WHERE run = 2 AND metric = 2",
        "UPDATE metric SET name = 'total_mt' WHERE name = 'total_ms'",
        "UPDATE run SET outcome = 'diverged' WHERE run = 1",
        "UPDATE run SET trial = 4 WHERE run = 1", "UPDATE run SET survey = 1 WHERE run = 1",
        "UPDATE run SET cell = -1 WHERE run = 1", "UPDATE run SET cell = '3abc' WHERE run = 1",
        "UPDATE run SET cell = 3.5 WHERE run = 1", "UPDATE run SET survey = x'00' WHERE run = 1",
        "UPDATE run SET trial = '0x' WHERE run = 1",
        "UPDATE estimator SET name = CAST(name AS BLOB) WHERE name = 'plain'",
        "INSERT INTO run SELECT 77, '3x', survey, trial, estimator, outcome, fault, "
        "log_hash, jobs, session, checksum FROM run WHERE run = 1",
        "UPDATE run SET estimator = 9 WHERE run = 1", "UPDATE run SET run = 77 WHERE run = 1",
        "UPDATE run SET checksum = checksum + 1 WHERE run = 2",
        "UPDATE series SET name = 'y' WHERE run = 1 AND name = 'x'",
        "UPDATE series SET data = x'00' WHERE run = 2 AND name = 'empty'",
        "DELETE FROM series WHERE run = 2 AND name = 'x'",
        "UPDATE estimator SET name = 'pluin' WHERE name = 'plain'",
        "UPDATE axis_value SET label = '11' WHERE axis = 0 AND place = 1",
        "UPDATE axis_value SET axis = 8 WHERE axis = 0 AND place = 1",
        "UPDATE study SET value = '99999999999999999999' WHERE key = 'trials'",
        "UPDATE study SET value = 'x' WHERE key = 'trials'",
        "UPDATE study SET value = '2' WHERE key = 'surveys'",
        "UPDATE configuration SET value = '3' WHERE key = 'seed'",
        "UPDATE session SET manifest = '{}' WHERE session = 1",
        "UPDATE session SET session = 2 WHERE session = 1"));

// Of somebody who knows the format: not damaged, and not as this program makes a store.
class ForeignStoreWith : public testing::TestWithParam<const char*> {};

TEST_P(ForeignStoreWith, IsRefusedBeforeItIsRead) {
  const TemporaryFolder folder;
  ResultStore::write(folder.path(), description(), "").finish();
  SQLite::Database((folder / "results.sqlite").string(), SQLite::OPEN_READWRITE).exec(GetParam());
  const auto is_another = HasSubstr("results.sqlite: is not as this program makes a store: ");
  EXPECT_THAT(input_error_of([&] { ResultStore::open(folder.path()); }), is_another);
  EXPECT_THAT(input_error_of([&] { ResultStore::write(folder.path(), description(), ""); }),
              is_another);
}

INSTANTIATE_TEST_SUITE_P(
    OneThing, ForeignStoreWith,
    testing::Values("CREATE TABLE more (x)", "CREATE INDEX faster ON run (cell)",
                    "DROP VIEW result",
                    "CREATE TRIGGER t AFTER INSERT ON run BEGIN DELETE FROM value; END",
                    "DROP TABLE value; CREATE VIEW value AS SELECT 1 AS run, 1 AS metric, "
                    "2.0 AS value",
                    "CREATE VIRTUAL TABLE words USING fts5(text)"));

// A name is a folder, too.
TEST(ForeignStore, WithANameThatLeavesTheFolderIsRefused) {
  const TemporaryFolder folder;
  StudyDescription study = description();
  study.estimators[0].name = "../../elsewhere";
  EXPECT_THAT(input_error_of([&] { ResultStore::write(folder.path(), study, ""); }),
              HasSubstr("has an estimator called '../../elsewhere'"));
}

TEST(ForeignStore, OfMoreTrialsThanAConfigurationMayHaveIsRefused) {
  const TemporaryFolder folder;
  StudyDescription study = description();
  study.trials = 100'000'000;
  EXPECT_THAT(input_error_of([&] { ResultStore::write(folder.path(), study, ""); }),
              HasSubstr("is of a study of 6 cells, 1e+08 trials in each; expected at most 1e+05 "
                        "and 1e+07"));
}

TEST(ForeignStore, WithAManifestLongerThanAnyIsRefused) {
  const TemporaryFolder folder;
  ResultStore::write(folder.path(), description(), "{}").finish();
  damage(folder.path(), "UPDATE session SET manifest = printf('%.*c', 17000000, 'x')");
  EXPECT_THAT(input_error_of([&] { ResultStore::open(folder.path()); }),
              HasSubstr("results.sqlite: holds a value that is longer than any that is stored"));
}

TEST(DamagedStore, TheRunThatIsDamagedIsNamed) {
  const TemporaryFolder folder;
  {
    ResultStore store = ResultStore::write(folder.path(), description(), "");
    store.add(record(3, 1, "plain"));
    store.finish();
  }
  damage(folder.path(), "UPDATE value SET value = 0 WHERE run = 1 AND metric = 1");
  EXPECT_THAT(
      input_error_of([&] { ResultStore::open(folder.path()); }),
      HasSubstr(
          "run 'plain', trial 1 of survey 0, cell 'separation 10, noise none' is not what was "
          "stored (its checksum differs); take the file from a copy"));
}

// Every bit of the pages that hold the numbers of one run: refused, or without any effect on what
// is read.
TEST(DamagedStore, NoFlippedBitGivesAnotherNumber) {
  const TemporaryFolder folder;
  {
    ResultStore store = ResultStore::write(folder.path(), description(), "{}");
    store.add(record(3, 1, "plain"));
    store.finish();
  }
  const fs::path file = folder / "results.sqlite";
  const std::string whole = read_file(file);
  const auto expected = ResultStore::open(file).runs();
  RandomStream random(23, "flipped bits");
  std::size_t refused = 0;
  for (int round = 0; round < 300; ++round) {
    std::string flipped = whole;
    const std::size_t bit = random.index(8 * whole.size());
    flipped[bit / 8] = static_cast<char>(flipped[bit / 8] ^ (1 << bit % 8));
    write_file(file, flipped);
    try {
      const ResultStore store = ResultStore::open(file);
      const auto runs = store.runs();
      ASSERT_EQ(runs.size(), expected.size()) << "bit " << bit;
      EXPECT_EQ(runs[0].key, expected[0].key) << "bit " << bit;
      EXPECT_EQ(runs[0].metrics, expected[0].metrics) << "bit " << bit;
      EXPECT_EQ(store.series(runs[0].key, "x"), record(0, 0, "").series.at("x")) << "bit " << bit;
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0u);
}

TEST(DamagedStore, IsNotOneThatAnotherProcessWritesJustNow) {
  const TemporaryFolder folder;
  StudyDescription study = description();
  study.trials = 400;
  ResultStore writer = ResultStore::write(folder.path(), study, "");
  std::atomic<bool> is_done = false;
  std::thread writing([&] {
    for (std::size_t trial = 0; trial < study.trials; ++trial) {
      for (std::size_t cell = 0; cell < 6; ++cell) writer.add(record(cell, trial, "plain"));
    }
    is_done = true;
  });
  std::size_t before = 0;
  while (!is_done && !HasFailure()) {
    EXPECT_NO_THROW({
      const std::size_t count = ResultStore::open(folder.path()).runs().size();
      EXPECT_GE(count, before);
      before = count;
    });
  }
  writing.join();
}

}  // namespace
}  // namespace fathom

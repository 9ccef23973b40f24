// Cells of runs.csv that a spreadsheet might run.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/report/study_report.hpp"
#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

// A label is anybody's text, and a spreadsheet runs what begins as a formula does.
TEST(CsvCells, NoneIsAFormula) {
  FixtureOptions options;
  options.trials = 2;
  options.separations = {"=1+1", "-cmd|x", "@a,\"b\"", "-5", "+3"};
  options.noises.clear();
  const TemporaryFolder folder;
  write_fixture(folder / "study", options);
  write_study_report(ResultStore::open(folder / "study"), folder / "out");
  const std::string runs = read_file(folder / "out" / "runs.csv");
  for (const char* const cell :
       {",\"'=1+1\",", ",\"'-cmd|x\",", ",\"'@a,\"\"b\"\"\",", ",-5,", ",+3,"}) {
    EXPECT_THAT(runs, HasSubstr(cell));
  }
}

}  // namespace
}  // namespace fathom::test

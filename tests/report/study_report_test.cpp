#include "fathom/report/study_report.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

TEST(StudyReport, WritesAllItsFiles) {
  const TemporaryFolder folder;
  write_fixture(folder / "study");
  write_study_report(ResultStore::open(folder / "study"), folder / "out");
  for (const char* name : {"report.html", "runs.csv", "summary.csv", "tables.tex"}) {
    EXPECT_TRUE(std::filesystem::exists(folder / "out" / name)) << name;
  }
}

}  // namespace
}  // namespace fathom::test

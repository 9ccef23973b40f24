// fathom report: a study's folder, or its file, into the files of a report.

#include <filesystem>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "report/study_fixture.hpp"
#include "support/requirements.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;

class ReportCommand : public CommandLine {
 protected:
  void SetUp() override {
    FixtureOptions options;
    options.surveys = 6;
    options.trials = 2;
    options.noises.clear();
    write_fixture(path("study"), options);
  }
};

TEST_F(ReportCommand, WritesIntoTheStudysFolder) {
  const Ended ended = fathom_done({"report", "study"});
  // The second estimator of the fixture states half of its spread.
  EXPECT_THAT(ended.out, ::testing::HasSubstr("\na&b_<c>%: Overconfident: ANEES is "));
  EXPECT_THAT(ended.out, ::testing::HasSubstr("\nVerdict\n"));
  EXPECT_THAT(ended.out, ::testing::EndsWith("\nwrote study/report.html\n"));
  EXPECT_THAT(tree(), IsSupersetOf({"study/report.html", "study/runs.csv", "study/summary.csv",
                                    "study/tables.tex", "study/figures/error_by_separation.pdf",
                                    "study/results.sqlite"}));
}

TEST_F(ReportCommand, WritesElsewhereAndTakesTheFile) {
  fathom_done({"report", "study/results.sqlite", "--out", "a/b"});
  EXPECT_THAT(tree(), IsSupersetOf({"a/b/report.html", "a/b/figures/nees_separation_5.svg"}));
  EXPECT_FALSE(fs::exists(path("study/report.html")));
}

TEST_F(ReportCommand, RefusesWhatIsNoStudy) {
  EXPECT_THAT(refusal({"report", "nowhere"}), HasSubstr("nowhere"));
  write("notes.sqlite", "notes");
  EXPECT_THAT(refusal({"report", "notes.sqlite"}), HasSubstr("notes.sqlite"));
}

TEST_F(ReportCommand, AReadOnlyFolderNeedsOut) {
  FATHOM_REQUIRE_NO_ROOT();
  fs::permissions(path("study"), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(refusal({"report", "study"}), HasSubstr("--out DIR takes another folder"));
  fathom_done({"report", "study", "--out", "out"});
  fs::permissions(path("study"), fs::perms::owner_all);
  EXPECT_TRUE(fs::exists(path("out/report.html")));
}

}  // namespace
}  // namespace fathom::test

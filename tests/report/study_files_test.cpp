// runs.csv, summary.csv and tables.tex of a study, and where they go.

#include <algorithm>
#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/report/study_report.hpp"
#include "report/csv_reader.hpp"
#include "report/study_fixture.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

std::string written(const FixtureOptions& options, const std::string& name) {
  const TemporaryFolder folder;
  write_fixture(folder / "study", options);
  write_study_report(ResultStore::open(folder / "study"), folder / "out");
  return read_file(folder / "out" / name);
}

TEST(StudyFiles, RunsReadBackToTheStoresBits) {
  const TemporaryFolder folder;
  write_fixture(folder / "study");
  const ResultStore store = ResultStore::open(folder / "study");
  write_study_report(store, folder / "out");
  const auto rows = read_csv(read_file(folder / "out" / "runs.csv"));
  const auto runs = store.runs();
  ASSERT_EQ(rows.size(), runs.size());
  ASSERT_EQ(rows.size(), 6u * 6u * 4u);
  for (const RunRecord& run : runs) {
    const auto row = std::find_if(rows.begin(), rows.end(), [&](const auto& fields) {
      return fields.at("cell") == std::to_string(run.key.cell) &&
             fields.at("survey") == std::to_string(run.key.survey) &&
             fields.at("trial") == std::to_string(run.key.trial) &&
             fields.at("estimator") == run.key.estimator;
    });
    ASSERT_NE(row, rows.end());
    EXPECT_EQ(row->at("outcome"), run.outcome);
    EXPECT_EQ(row->at("jobs"), "2");
    EXPECT_EQ(row->at("association"), "shared");
    std::size_t present = 0;
    for (const std::string metric : {"mean_position_error_m", "anees", "update_ms.median",
                                     "memory_bytes", "keyframes", "chi2"}) {
      const auto known = run.metrics.find(metric);
      const std::string& field = row->at(metric);
      EXPECT_EQ(field.empty(), known == run.metrics.end()) << metric;
      if (!field.empty()) {
        EXPECT_EQ(std::stod(field), known->second) << metric;
      }
      present += field.empty() ? 0 : 1;
    }
    EXPECT_GE(present, 1u);
  }
  // Cell 3 is the second separation with the second noise.
  const auto fourth = std::find_if(rows.begin(), rows.end(),
                                   [](const auto& fields) { return fields.at("cell") == "3"; });
  EXPECT_EQ(fourth->at("separation"), "10");
  EXPECT_EQ(fourth->at("noise, \"odometry\""), "high & <b>50%</b>");
}

TEST(StudyFiles, SummaryHasTheMomentsOfTheRunsThatWereDone) {
  const auto runs = read_csv(written({}, "runs.csv"));
  const auto summary = read_csv(written({}, "summary.csv"));
  std::size_t compared = 0;
  for (const auto& line : summary) {
    std::vector<double> values;
    std::size_t failures = 0;
    for (const auto& run : runs) {
      if (run.at("cell") != line.at("cell") || run.at("estimator") != line.at("estimator"))
        continue;
      const bool failed =
          run.at("outcome") == "diverged" || run.at("outcome") == "numerical_failure";
      failures += failed ? 1 : 0;
      const std::string& field = run.at(line.at("metric"));
      if (!failed && !field.empty()) values.push_back(std::stod(field));
    }
    EXPECT_EQ(line.at("failures"), std::to_string(failures));
    EXPECT_EQ(line.at("n"), std::to_string(values.size()));
    EXPECT_EQ(line.at("surveys"), values.empty() ? "0" : "1");
    if (values.empty()) {
      EXPECT_EQ(line.at("mean"), "");
      continue;
    }
    double mean = 0.0;
    for (const double value : values) mean += value / static_cast<double>(values.size());
    double squares = 0.0;
    for (const double value : values) squares += (value - mean) * (value - mean);
    const double sd = std::sqrt(squares / static_cast<double>(values.size() - 1));
    std::sort(values.begin(), values.end());
    const double median = 0.5 * (values[(values.size() - 1) / 2] + values[values.size() / 2]);
    EXPECT_NEAR(std::stod(line.at("mean")), mean, 1e-12 * std::abs(mean));
    EXPECT_NEAR(std::stod(line.at("sd")), sd, 1e-9 * std::abs(mean));
    EXPECT_NEAR(std::stod(line.at("median")), median, 1e-12 * std::abs(mean));
    EXPECT_LE(std::stod(line.at("low_95")), mean + 1e-12 * std::abs(mean));
    EXPECT_GE(std::stod(line.at("high_95")), mean - 1e-12 * std::abs(mean));
    ++compared;
  }
  EXPECT_GT(compared, 100u);
}

TEST(StudyFiles, AnEstimatorThatAlwaysFailsKeepsItsLines) {
  const TemporaryFolder folder;
  StudyDescription study = fixture_study({});
  study.axes.clear();
  {
    ResultStore store = ResultStore::write(folder.path(), study, "{}");
    for (std::size_t trial = 0; trial < 3; ++trial) {
      RunRecord run;
      run.key = {0, 0, trial, "graph"};
      run.outcome = "diverged";
      run.metrics = {{"anees", 1e9}};
      store.add(run);
    }
    store.finish();
  }
  const ResultStore store = ResultStore::open(folder.path());
  write_study_report(store, folder / "out");
  const auto summary = read_csv(read_file(folder / "out" / "summary.csv"));
  ASSERT_EQ(summary.size(), 1u);
  EXPECT_EQ(summary[0].at("n"), "0");
  EXPECT_EQ(summary[0].at("failures"), "3");
  EXPECT_EQ(summary[0].at("mean"), "");
  EXPECT_THAT(study_table(store), HasSubstr("0/3 done, 3 diverged"));
}

TEST(StudyFiles, OneTrialHasNeitherSpreadNorInterval) {
  FixtureOptions options;
  options.trials = 1;
  const auto summary = read_csv(written(options, "summary.csv"));
  ASSERT_FALSE(summary.empty());
  for (const auto& line : summary) {
    EXPECT_EQ(line.at("sd"), "");
    EXPECT_EQ(line.at("low_95"), "");
  }
  EXPECT_THAT(written(options, "tables.tex"), Not(HasSubstr("bootstrap")));
}

TEST(StudyFiles, LatexTablesAreEscapedAndSayTheirConditions) {
  const std::string tex = written({}, "tables.tex");
  EXPECT_THAT(tex, HasSubstr("Loops \\& \\textless{}noise\\textgreater{}: 50 \\% of a\\_b "
                             "\\textless{}/script\\textgreater{}"));
  EXPECT_THAT(tex, HasSubstr("    a\\&b\\_\\textless{}c\\textgreater{}\\% & "));
  EXPECT_THAT(tex, HasSubstr("association shared, alignment origin, 1 survey $\\times$ 6 trials"));
  EXPECT_THAT(tex, HasSubstr(" & 4/6 & "));
  EXPECT_THAT(tex, HasSubstr("\\toprule"));
  // Nothing special is left bare; of our own making are the $ and the & between cells.
  for (std::size_t i = 0; i < tex.size(); ++i) {
    const bool escaped = i > 0 && tex[i - 1] == '\\';
    if (tex[i] == '_' || tex[i] == '#') {
      EXPECT_TRUE(escaped) << tex.substr(i, 30);
    }
    if (tex[i] == '%' && i > 0) {
      EXPECT_TRUE(escaped) << tex.substr(i, 30);
    }
    if (tex[i] == '&' && !escaped) {
      EXPECT_EQ(tex.substr(i - 1, 3), " & ");
    }
    EXPECT_NE(tex[i], '<');
  }
  std::size_t tables = 0;
  for (std::size_t at = 0; (at = tex.find("\\begin{tabular}{lrrrrr}", at)) != std::string::npos;) {
    ++at;
    ++tables;
  }
  EXPECT_EQ(tables, 6u);
}

// The study's own alignment is that of its first cell.
TEST(StudyFiles, EveryCellSaysHowItWasAligned) {
  FixtureOptions options;
  options.trials = 2;
  options.separations.clear();
  options.noises.clear();
  options.alignments = {"origin", "se2"};
  const std::string tex = written(options, "tables.tex");
  EXPECT_THAT(
      tex,
      HasSubstr(
          "aligned by origin: association shared, alignment origin, 1 survey $\\times$ 2 trials"));
  EXPECT_THAT(
      tex,
      HasSubstr("aligned by se2: association shared, alignment se2, 1 survey $\\times$ 2 trials"));
  const auto runs = read_csv(written(options, "runs.csv"));
  ASSERT_EQ(runs.size(), 16u);
  EXPECT_EQ(runs.front().at("alignment"), "origin");
  EXPECT_EQ(runs.back().at("alignment"), "se2");
  options.separations = {"1", "2", "3", "4"};
  EXPECT_THAT(written(options, "tables.tex"),
              HasSubstr("alignment origin/se2, association shared"));
}

TEST(StudyFiles, ManyCellsHaveATableAMetric) {
  FixtureOptions options;
  options.trials = 3;
  options.separations = {"1", "2", "3", "4"};
  const std::string tex = written(options, "tables.tex");
  EXPECT_THAT(tex, HasSubstr("mean position error (m): alignment origin, association shared, 1 "
                             "survey $\\times$ 3 trials"));
  EXPECT_THAT(tex, HasSubstr("cell & dead reckoning & iterated"));
  EXPECT_THAT(tex, HasSubstr("(1/3)"));
}

// A name of a file has at most 255 bytes.
TEST(StudyFiles, LongLabelsStandInTheTablesWhole) {
  FixtureOptions options;
  options.trials = 2;
  options.separations = {std::string(300, 'a'), std::string(300, 'a') + "b", "../c"};
  options.noises.clear();
  const TemporaryFolder folder;
  write_fixture(folder / "study", options);
  write_study_report(ResultStore::open(folder / "study"), folder / "out");
  EXPECT_THAT(read_file(folder / "out" / "tables.tex"), HasSubstr(options.separations[1]));
  std::size_t figures = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder / "out" / "figures")) {
    EXPECT_LE(entry.path().filename().string().size(), 84u);
    ++figures;
  }
  EXPECT_EQ(figures, 2u * (1 + 3 * 3));  // of the sweep, and three kinds of each cell
}

TEST(StudyFiles, AFolderThatCannotBeWrittenIsBadInput) {
  const TemporaryFolder folder;
  write_fixture(folder / "study");
  const ResultStore store = ResultStore::open(folder / "study");
  EXPECT_THAT(input_error_of([&] { write_study_report(store, "/proc/fathom"); }),
              HasSubstr("/proc/fathom: cannot be made"));
  write_file(folder / "file", "");
  EXPECT_THAT(input_error_of([&] { write_study_report(store, folder / "file"); }),
              HasSubstr("is a file"));
}

TEST(StudyFiles, AStudyWithoutRunsIsBadInput) {
  const TemporaryFolder folder;
  { ResultStore::write(folder.path(), fixture_study(), "{}").finish(); }
  const ResultStore store = ResultStore::open(folder.path());
  EXPECT_THAT(input_error_of([&] { write_study_report(store, folder / "out"); }),
              HasSubstr("no results yet"));
  EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

}  // namespace
}  // namespace fathom::test

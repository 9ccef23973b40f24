#include "src/report/study_figures.hpp"

#include <algorithm>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/report/study_report.hpp"
#include "report/placed_texts.hpp"
#include "report/study_fixture.hpp"
#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;
using ::testing::UnorderedElementsAre;

std::vector<std::string> names_in(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(folder)) {
    names.push_back(entry.path().filename().string());
  }
  return names;
}

void write_report(const TemporaryFolder& folder, const FixtureOptions& options) {
  write_fixture(folder / "study", options);
  write_study_report(ResultStore::open(folder / "study"), folder / "out");
}

FixtureOptions one_cell() {
  FixtureOptions options;
  options.separations.clear();
  options.noises.clear();
  return options;
}

TEST(StudyFigures, OfOneCellHaveShortNames) {
  const TemporaryFolder folder;
  write_report(folder, one_cell());
  EXPECT_THAT(names_in(folder / "out" / "figures"),
              UnorderedElementsAre("nees.svg", "nees.pdf", "trajectories.svg", "trajectories.pdf",
                                   "accuracy_against_cost.svg", "accuracy_against_cost.pdf"));
}

TEST(StudyFigures, EverySweepHasOne) {
  const TemporaryFolder folder;
  FixtureOptions options;
  options.noises.clear();
  write_report(folder, options);
  const auto figures = folder / "out" / "figures";
  EXPECT_TRUE(fs::exists(figures / "error_by_separation.svg"));
  EXPECT_TRUE(fs::exists(figures / "error_by_separation.pdf"));
  for (const char* cell : {"5", "10", "20"}) {
    EXPECT_TRUE(fs::exists(figures / ("nees_separation_" + std::string(cell) + ".svg"))) << cell;
  }
}

TEST(StudyFigures, NamesThatComeToTheSameAreKeptApart) {
  const TemporaryFolder folder;
  FixtureOptions options;
  options.trials = 2;
  options.separations = {"a&b", "a<b"};
  options.noises.clear();
  write_report(folder, options);
  EXPECT_TRUE(fs::exists(folder / "out" / "figures" / "nees_separation_a_b.svg"));
  EXPECT_TRUE(fs::exists(folder / "out" / "figures" / "nees_separation_a_b-2.svg"));
}

TEST(StudyFigures, WithoutGroundTruthOnlyTrajectoriesAreThere) {
  const TemporaryFolder folder;
  FixtureOptions options = one_cell();
  options.ground_truth = false;
  write_report(folder, options);
  EXPECT_THAT(names_in(folder / "out" / "figures"),
              UnorderedElementsAre("trajectories.svg", "trajectories.pdf"));
}

std::size_t zeros_in(const std::vector<PlacedText>& texts) {
  return static_cast<std::size_t>(std::count_if(
      texts.begin(), texts.end(), [](const auto& one) { return parse_real(one.text) == 0.0; }));
}

// On a linear axis, which begins at 0, a thousandfold error presses the others onto zero.
TEST(StudyFigures, DeadReckoningFarAboveTheRestHasALogarithmicAxis) {
  for (const double factor : {1.0, 1000.0}) {
    const TemporaryFolder folder;
    FixtureOptions options;
    options.noises.clear();
    options.baseline = factor;
    write_fixture(folder / "study", options);
    const ResultStore store = ResultStore::open(folder / "study");
    const StudyResults results = study_results(store);
    const auto series = study_series(store, results);
    const auto examples = example_trials(store, results);
    for (const StudyFigure& figure : study_figures({results, series, examples})) {
      if (figure.name != "error_by_separation") continue;
      const PageSize page{kFigureWidth, figure.height};
      const auto texts = texts_of(page, figure.draw);
      expect_tidy(texts, page);
      EXPECT_EQ(zeros_in(texts) > 0, factor == 1.0);
    }
  }
}

// The share of a channel as cairo writes it: 0x72 is 44.7 %.
TEST(StudyFigures, AreDrawnInTheColoursOfTheEstimators) {
  const TemporaryFolder folder;
  write_report(folder, one_cell());
  for (const char* name : {"nees", "trajectories", "accuracy_against_cost"}) {
    const fs::path file = folder / "out" / "figures" / name;
    std::string svg = read_file(file.string() + ".svg");
    EXPECT_THAT(svg, StartsWith("<?xml"));
    EXPECT_THAT(svg, HasSubstr("</svg>"));
    std::erase(svg, ' ');                        // Cairo 1.18 writes one after each comma
    EXPECT_THAT(svg, HasSubstr("rgb(0%,44.7"));  // #0072b2, trajectory_iekf
    EXPECT_THAT(svg, HasSubstr("rgb(83.5"));     // #d55e00, ekf
    EXPECT_THAT(svg, HasSubstr("rgb(0%,61.9"));  // #009e73, ceres_pose_graph
    const std::string pdf = read_file(file.string() + ".pdf");
    EXPECT_THAT(pdf, StartsWith("%PDF-"));
    EXPECT_THAT(pdf, HasSubstr("%%EOF"));
    EXPECT_GT(pdf.size(), 3000u);
  }
}

// Of small, usual and large errors, with long labels and more estimators than colours.
TEST(StudyFigures, NoTextRunsIntoAnother) {
  for (const double size : {1e-6, 1e-3, 1.0, 1e5}) {
    const TemporaryFolder folder;
    FixtureOptions options;
    options.trials = 2;
    options.size = size;
    options.separations = {"5", "10", std::string(120, 'L')};
    write_fixture(folder / "study", options);
    const ResultStore store = ResultStore::open(folder / "study");
    const StudyResults results = study_results(store);
    const auto series = study_series(store, results);
    const auto examples = example_trials(store, results);
    for (const StudyFigure& figure : study_figures({results, series, examples})) {
      SCOPED_TRACE(figure.name.substr(0, 60) + " " + std::to_string(size));
      const PageSize page{kFigureWidth, figure.height};
      const auto texts = texts_of(page, figure.draw);
      EXPECT_GT(texts.size(), 8U);
      expect_tidy(texts, page);
    }
  }
}

TEST(StudyFigures, SayTheAlignmentOfTheirCell) {
  const TemporaryFolder folder;
  FixtureOptions options = one_cell();
  options.alignments = {"origin", "se2"};
  write_fixture(folder / "study", options);
  const ResultStore store = ResultStore::open(folder / "study");
  const StudyResults results = study_results(store);
  const auto series = study_series(store, results);
  const auto examples = example_trials(store, results);
  std::size_t found = 0;
  for (const StudyFigure& figure : study_figures({results, series, examples})) {
    if (!figure.name.ends_with("se2")) continue;
    ++found;
    std::string all;
    for (const PlacedText& text : texts_of({kFigureWidth, figure.height}, figure.draw)) {
      all += text.text + " ";
    }
    EXPECT_THAT(all, HasSubstr("alignment se2")) << figure.name;
  }
  EXPECT_EQ(found, 3u);
}

std::string texts_in(const std::string& name, const FixtureOptions& options) {
  const TemporaryFolder folder;
  write_fixture(folder / "study", options);
  const ResultStore store = ResultStore::open(folder / "study");
  const StudyResults results = study_results(store);
  const auto series = study_series(store, results);
  const auto examples = example_trials(store, results);
  std::string all;
  for (const StudyFigure& figure : study_figures({results, series, examples})) {
    if (figure.name != name) continue;
    const PageSize page{kFigureWidth, figure.height};
    const auto texts = texts_of(page, figure.draw);
    expect_tidy(texts, page);
    for (const PlacedText& text : texts) all += text.text + "; ";
  }
  return all;
}

// "iterated" is the first that left some out.
TEST(StudyFigures, TheMapHasWhatWasMeasuredAndLeftOut) {
  FixtureOptions options = one_cell();
  EXPECT_THAT(texts_in("trajectories", options), ::testing::Not(HasSubstr("fix")));
  options.absolute = true;
  EXPECT_THAT(texts_in("trajectories", options),
              HasSubstr("; fix; fix left out by iterated; measured heading; "
                        "heading left out by iterated; "));
  options.absolute_is_old = true;
  EXPECT_THAT(texts_in("trajectories", options), ::testing::Not(HasSubstr("fix")));
}

TEST(StudyFigures, TheCaptionOfASweepIsOfAllPoints) {
  FixtureOptions options;
  options.alignments = {"origin", "se2"};
  options.noises.clear();
  const std::string words = texts_in("error_by_separation_aligned_by_se2", options);
  EXPECT_THAT(words, HasSubstr("alignment se2"));
  EXPECT_THAT(words, ::testing::Not(HasSubstr("5:")));
  EXPECT_THAT(words, HasSubstr("band: mean"));
}

bool has_front(const ChartInput& input) {
  for (const StudyFigure& figure : study_figures(input)) {
    if (figure.name != "accuracy_against_cost") continue;
    for (const PlacedText& text : texts_of({kFigureWidth, figure.height}, figure.draw)) {
      if (text.text == "Pareto front") return true;
    }
  }
  return false;
}

// ANEES is best at 1.
TEST(StudyFigures, AMetricWithoutABetterDirectionHasNoFront) {
  const TemporaryFolder folder;
  write_fixture(folder / "study", one_cell());
  const ResultStore store = ResultStore::open(folder / "study");
  StudyResults results = study_results(store);
  const auto series = study_series(store, results);
  const auto examples = example_trials(store, results);
  EXPECT_TRUE(has_front({results, series, examples}));
  results.study.metrics = {"anees", "total_ms"};
  EXPECT_FALSE(has_front({results, series, examples}));
}

TEST(StudyFigures, OldOnesGoWithANewReport) {
  const TemporaryFolder folder;
  write_report(folder, one_cell());
  write_file(folder / "out" / "figures" / "left_over.svg", "");
  write_file(folder / "out" / "notes.txt", "mine");
  write_study_report(ResultStore::open(folder / "study"), folder / "out");
  EXPECT_FALSE(fs::exists(folder / "out" / "figures" / "left_over.svg"));
  EXPECT_EQ(read_file(folder / "out" / "notes.txt"), "mine");
}

}  // namespace
}  // namespace fathom::test

// How often a study's statistics are wrong, on drawn studies whose truth is known: how often one of
// several exchangeable estimators is called worse, how often one that is off by the margin is
// called equivalent, and how often a 95 % interval holds the mean. Prints Markdown tables.
//
//   study_errors [--repeats N] [--seed S] [--table worse|equivalent|coverage]

#include <cmath>
#include <cstdio>
#include <exception>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "fathom/core/random.hpp"
#include "fathom/evaluation/clustered.hpp"
#include "src/report/ranking.hpp"

namespace fathom {
namespace {

constexpr const char* kMetric = "mean_position_error_m";
constexpr std::size_t kTrials = 5;

// Of mean 1: normal with a deviation of 0.3, or log-normal.
enum class Shape { normal, skewed, heavy };

const char* name_of(Shape shape) {
  switch (shape) {
    case Shape::normal:
      return "normal";
    case Shape::skewed:
      return "log-normal, 0.5";
    case Shape::heavy:
      break;
  }
  return "log-normal, 1";
}

double drawn(Shape shape, RandomStream& random) {
  if (shape == Shape::normal) return 1.0 + 0.3 * random.normal();
  const double sigma = shape == Shape::skewed ? 0.5 : 1.0;
  return std::exp(sigma * random.normal() - 0.5 * sigma * sigma);
}

// An error has a part of the survey, one of the estimator on it, and one of the trial.
struct DrawnStudy {
  std::size_t estimators = 2;
  std::size_t surveys = 10;
  Shape shape = Shape::normal;
  double last_is_off = 0.0;  // added to the errors of the last estimator
};

CellResults cell_of(const DrawnStudy& study, RandomStream& random) {
  CellResults cell;
  cell.surveys = study.surveys;
  cell.trials = study.surveys * kTrials;
  cell.estimators.resize(study.estimators);
  std::vector<ClusteredValues> values(study.estimators);
  for (std::size_t s = 0; s < study.surveys; ++s) {
    const double of_survey = drawn(study.shape, random);
    for (std::size_t e = 0; e < study.estimators; ++e) {
      const double of_both = of_survey * drawn(study.shape, random);
      for (std::size_t t = 0; t < kTrials; ++t) {
        RunRecord run;
        run.key = {0, s, t, "estimator " + std::to_string(e)};
        run.outcome = "converged";
        const double off = e + 1 == study.estimators ? study.last_is_off : 0.0;
        run.metrics[kMetric] = of_both * drawn(study.shape, random) + off;
        values[e][s].push_back(run.metrics[kMetric]);
        cell.estimators[e].runs.push_back(std::move(run));
      }
    }
  }
  for (std::size_t e = 0; e < study.estimators; ++e) {
    EstimatorResults& one = cell.estimators[e];
    one.name = one.runs.front().key.estimator;
    one.done = one.runs.size();
    one.metrics[kMetric].moments.mean = clustered_mean(values[e]);
  }
  return cell;
}

struct Counts {
  std::size_t studies = 0;
  std::size_t with_verdict = 0;
  std::size_t with_worse = 0;
  std::size_t with_equivalent = 0;
};

Counts counted(const DrawnStudy& study, double margin, std::size_t repeats, std::uint64_t seed) {
  RandomStream random(seed, "study errors");
  Counts counts;
  for (std::size_t i = 0; i < repeats; ++i) {
    const auto ranked = ranking(cell_of(study, random), kMetric, {.margin = margin});
    ++counts.studies;
    counts.with_verdict += ranked->gives_verdict() ? 1 : 0;
    counts.with_worse += ranked->standing(Standing::worse).empty() ? 0 : 1;
    counts.with_equivalent += ranked->standing(Standing::equivalent).empty() ? 0 : 1;
  }
  return counts;
}

double percent(std::size_t part, std::size_t all) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(all);
}

// Of estimators that are alike.
void print_worse(std::size_t repeats, std::uint64_t seed) {
  std::printf("| errors | estimators | surveys | verdict given | one is called worse, %% |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const Shape shape : {Shape::normal, Shape::heavy}) {
    for (const std::size_t estimators : {2, 3, 5, 10}) {
      for (const std::size_t surveys : {1, 2, 3, 5, 6, 7, 8, 9, 10, 12, 15, 20}) {
        const Counts counts = counted({estimators, surveys, shape}, 0.0, repeats, seed);
        std::printf("| %s | %zu | %zu | %s | %.2f |\n", name_of(shape), estimators, surveys,
                    counts.with_verdict > 0 ? "yes" : "no",
                    percent(counts.with_worse, counts.studies));
      }
    }
  }
}

// Of two, of which one is off by the margin. The margin is chosen for the spread of the difference:
// one that is never or always reached would test nothing.
void print_equivalent(std::size_t repeats, std::uint64_t seed) {
  std::printf(
      "| errors | surveys | margin, %% | called equivalent, %% | equivalent where alike, %% |\n");
  std::printf("|---|---|---|---|---|\n");
  for (const Shape shape : {Shape::normal, Shape::heavy}) {
    for (const std::size_t surveys : {6, 10, 20}) {
      for (const double margin : {0.3, 1.0}) {
        const Counts off = counted({2, surveys, shape, margin}, margin, repeats, seed);
        const Counts alike = counted({2, surveys, shape, 0.0}, margin, repeats, seed);
        std::printf("| %s | %zu | %.0f | %.2f | %.2f |\n", name_of(shape), surveys, 100.0 * margin,
                    percent(off.with_equivalent, off.studies),
                    percent(alike.with_equivalent, alike.studies));
      }
    }
  }
}

// Of means, which are 1.
void print_coverage(std::size_t repeats, std::uint64_t seed) {
  std::printf("| errors | surveys | trials of each | the 95 %% interval holds the mean, %% |\n");
  std::printf("|---|---|---|---|\n");
  struct Size {
    std::size_t surveys;
    std::size_t trials;
  };
  for (const Shape shape : {Shape::normal, Shape::skewed, Shape::heavy}) {
    for (const auto& [surveys, trials] :
         {Size{1, 5}, Size{1, 10}, Size{1, 20}, Size{1, 50}, Size{1, 200}, Size{3, 5}, Size{5, 5},
          Size{10, 5}, Size{20, 5}}) {
      RandomStream random(seed, "coverage");
      std::size_t held = 0;
      for (std::size_t i = 0; i < repeats; ++i) {
        ClusteredValues values;
        for (std::size_t s = 0; s < surveys; ++s) {
          // The only survey is the one that is asked about.
          const double of_survey = surveys > 1 ? drawn(shape, random) : 1.0;
          for (std::size_t t = 0; t < trials; ++t) {
            values[s].push_back(of_survey * drawn(shape, random));
          }
        }
        held += hierarchical_interval(values)->contains(1.0) ? 1 : 0;
      }
      std::printf("| %s | %zu | %zu | %.1f |\n", name_of(shape), surveys, trials,
                  percent(held, repeats));
    }
  }
}

int run(int argc, const char* const* argv) {
  std::size_t repeats = 1000;
  std::uint64_t seed = 1;
  std::string only;
  CLI::App app{"Error rates of verdicts and coverage of intervals, on drawn studies."};
  app.add_option("--repeats", repeats, "studies a row")->check(CLI::PositiveNumber);
  app.add_option("--seed", seed, "of the draws");
  app.add_option("--table", only, "this one alone")
      ->check(CLI::IsMember({"worse", "equivalent", "coverage"}));
  CLI11_PARSE(app, argc, argv);
  const auto is_asked = [&only](const char* table) { return only.empty() || only == table; };
  if (is_asked("worse")) print_worse(repeats, seed);
  if (only.empty()) std::printf("\n");
  if (is_asked("equivalent")) print_equivalent(repeats, seed);
  if (only.empty()) std::printf("\n");
  if (is_asked("coverage")) print_coverage(repeats, seed);
  return 0;
}

}  // namespace
}  // namespace fathom

int main(int argc, char** argv) try {
  return fathom::run(argc, argv);
} catch (const std::exception& error) {
  std::fprintf(stderr, "study_errors: error: %s\n", error.what());
  return 1;
}

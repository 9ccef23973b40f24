// How often verdicts are wrong.

#include <cstdio>
#include <string>
#include <utility>
#include <vector>

#include "draws.hpp"
#include "fathom/evaluation/clustered.hpp"
#include "src/report/ranking.hpp"

namespace fathom::study_errors {
namespace {

constexpr const char* kMetric = "mean_position_error_m";
constexpr std::size_t kTrials = 5;

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

// Trials of drawn logs. Two estimators are alike but for a wrong minimum of the second, with such a
// chance in each trial, which multiplies its error.
CellResults cell_of_rare(std::size_t trials, double chance, double times, RandomStream& random) {
  CellResults cell;
  cell.surveys = 1;
  cell.trials = trials;
  cell.repetition = Repetition::logs;
  cell.estimators.resize(2);
  for (std::size_t e = 0; e < 2; ++e) cell.estimators[e].name = e == 0 ? "sound" : "rarely wrong";
  for (std::size_t t = 0; t < trials; ++t) {
    const double error = drawn(Shape::normal, random);
    const bool is_wrong = random.uniform(0.0, 1.0) < chance;
    for (std::size_t e = 0; e < 2; ++e) {
      RunRecord run;
      run.key = {0, 0, t, cell.estimators[e].name};
      run.outcome = "converged";
      run.metrics[kMetric] = error * (e == 1 && is_wrong ? times : 1.0);
      cell.estimators[e].runs.push_back(std::move(run));
    }
  }
  for (EstimatorResults& one : cell.estimators) {
    one.done = trials;
    std::vector<double> values;
    for (const RunRecord& run : one.runs) values.push_back(run.metrics.at(kMetric));
    one.metrics[kMetric].moments = *moments(values);
  }
  return cell;
}

}  // namespace

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

void print_rare(std::size_t repeats, std::uint64_t seed) {
  std::printf(
      "| trials | chance of a wrong minimum, %% | its error, times | true difference, %% | called "
      "equivalent, %% |\n");
  std::printf("|---|---|---|---|---|\n");
  constexpr double kChance = 0.02;
  constexpr double kMargin = 0.01;
  for (const std::size_t trials : {20, 50, 150, 500}) {
    for (const double times : {1.5, 11.0}) {
      RandomStream random(seed, "rare errors");
      std::size_t equivalent = 0;
      for (std::size_t i = 0; i < repeats; ++i) {
        const auto ranked =
            ranking(cell_of_rare(trials, kChance, times, random), kMetric, {.margin = kMargin});
        equivalent += ranked->standing(Standing::equivalent).empty() ? 0 : 1;
      }
      std::printf("| %zu | %.0f | %.1f | %.0f | %.2f |\n", trials, 100.0 * kChance, times,
                  100.0 * kChance * (times - 1.0), percent(equivalent, repeats));
    }
  }
}

}  // namespace fathom::study_errors

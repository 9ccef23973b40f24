#include "fathom/evaluation/clustered.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <functional>
#include <numeric>

#include "checks.hpp"
#include "distributions.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/core/random.hpp"

namespace fathom {
namespace {

double common_mean(const std::vector<double>& values) {
  // Where all are equal a sum would round.
  if (std::ranges::adjacent_find(values, std::not_equal_to<>()) == values.end()) {
    return values.front();
  }
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

std::vector<double> without_mean(std::vector<double> values) {
  // Twice, as the first mean was rounded to its own size.
  for (int pass = 0; pass < 2; ++pass) {
    const double mean = common_mean(values);
    for (double& value : values) value -= mean;
  }
  return values;
}

double resampled_mean(const std::vector<double>& values, RandomStream& random) {
  if (values.size() == 1) return values.front();
  double sum = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) sum += values[random.index(values.size())];
  return sum / static_cast<double>(values.size());
}

// The trials of a survey in one cell: what they add to the estimate is this share of their mean.
struct Trials {
  double share = 0.0;
  std::vector<double> deviations;  ///< from their mean
};

struct SurveyOfCells {
  double deviation = 0.0;  ///< of the estimate, by this survey's means instead of the cells'
  std::vector<Trials> trials;
};

std::vector<SurveyOfCells> surveys_of(std::span<const ClusteredValues> cells) {
  std::map<std::size_t, SurveyOfCells> surveys;
  for (const ClusteredValues& cell : cells) {
    const double share = 1.0 / static_cast<double>(cells.size() * cell.size());
    const std::vector<double> deviations = without_mean(survey_means(cell));
    auto deviation = deviations.begin();
    for (const auto& [survey, values] : cell) {
      surveys[survey].deviation += share * *deviation++;
      surveys[survey].trials.push_back({share, without_mean(values)});
    }
  }
  std::vector<SurveyOfCells> list;
  list.reserve(surveys.size());
  for (auto& [survey, one] : surveys) list.push_back(std::move(one));
  return list;
}

// By what the surveys' deviations are multiplied, so that the spread within them counts once.
double shrinkage(const std::vector<SurveyOfCells>& surveys) {
  double between = 0.0;
  double within = 0.0;
  for (const SurveyOfCells& survey : surveys) {
    between += survey.deviation * survey.deviation;
    for (const Trials& trials : survey.trials) {
      const auto count = static_cast<double>(trials.deviations.size());
      double squares = 0.0;
      for (const double deviation : trials.deviations) squares += deviation * deviation;
      within += trials.share * trials.share * squares / (count * count);
    }
  }
  return between > 0.0 ? std::sqrt(std::max(0.0, 1.0 - within / between)) : 0.0;
}

double replicate(const std::vector<SurveyOfCells>& surveys, double shrink, RandomStream& random) {
  double sum = 0.0;
  for (std::size_t i = 0; i < surveys.size(); ++i) {
    const SurveyOfCells& drawn = surveys[random.index(surveys.size())];
    sum += shrink * drawn.deviation;
    for (const Trials& trials : drawn.trials) {
      sum += trials.share * resampled_mean(trials.deviations, random);
    }
  }
  return sum;
}

Interval interval_about(double estimate, const std::vector<SurveyOfCells>& surveys,
                        const BootstrapOptions& options) {
  if (options.resamples == 0) throw InputError("a bootstrap interval needs at least 1 resample");
  const double shrink = shrinkage(surveys);
  RandomStream random(options.seed, "hierarchical bootstrap");
  std::vector<double> replicates(options.resamples);
  for (double& value : replicates) value = replicate(surveys, shrink, random);
  const auto count = static_cast<double>(surveys.size());
  std::vector<double> jackknife;
  jackknife.reserve(surveys.size());
  for (const SurveyOfCells& survey : surveys) {
    jackknife.push_back(-survey.deviation * count / (count - 1.0));
  }
  const Interval about = bca_interval(0.0, replicates, jackknife, options.probability);
  const double widened = few_values(surveys.size(), options.probability);
  return {estimate + widened * about.low, estimate + widened * about.high};
}

}  // namespace

std::vector<double> survey_means(const ClusteredValues& values) {
  std::vector<double> means;
  means.reserve(values.size());
  for (const auto& [survey, own] : values) means.push_back(common_mean(own));
  return means;
}

double clustered_mean(const ClusteredValues& values) {
  assert(!values.empty());
  return common_mean(survey_means(values));
}

std::optional<Interval> hierarchical_interval(const ClusteredValues& values,
                                              const BootstrapOptions& options) {
  if (values.size() == 1) return bootstrap_interval(values.begin()->second, options);
  return interval_over_cells(std::span(&values, 1), options);
}

std::optional<Interval> interval_over_cells(std::span<const ClusteredValues> cells,
                                            const BootstrapOptions& options) {
  double estimate = 0.0;
  for (const ClusteredValues& cell : cells) {
    for (const auto& [survey, values] : cell) require_finite(values, "a bootstrap interval");
    if (cell.size() < 2) return std::nullopt;
    estimate += clustered_mean(cell) / static_cast<double>(cells.size());
  }
  const std::vector<SurveyOfCells> surveys = surveys_of(cells);
  assert(surveys.size() > 1);
  return interval_about(estimate, surveys, options);
}

}  // namespace fathom

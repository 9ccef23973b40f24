#include "ranking.hpp"

#include <algorithm>
#include <cmath>

#include "contenders.hpp"
#include "fathom/report/table.hpp"
#include "honesty.hpp"

namespace fathom {
namespace {

constexpr double kError = 0.05;  // of all claims of a ranking together
constexpr std::size_t kResamples = 2000;

// Adjusted p of each against the best, which is one of all pairs.
std::vector<std::optional<double>> p_values(const Contenders& compared, const std::string& metric) {
  const std::vector<Contender>& order = compared.order;
  std::vector<double> tested;
  std::vector<std::optional<std::size_t>> of_best(order.size());
  for (std::size_t i = 0; i < order.size(); ++i) {
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      const auto test = test_between(*order[j].one, *order[i].one, metric, &compared.trials);
      // Without a difference nothing is tested, but it counts as a pair.
      if (i == 0 && test && test->p_value) of_best[j] = tested.size();
      tested.push_back(test && test->p_value ? *test->p_value : 1.0);
    }
  }
  const std::vector<double> adjusted = holm(tested);
  std::vector<std::optional<double>> values(order.size());
  for (std::size_t j = 0; j < order.size(); ++j) {
    if (of_best[j]) values[j] = adjusted[*of_best[j]];
  }
  return values;
}

// One estimator beside the best, whose mean is known no better than the difference: the margin is a
// share of it in every draw.
struct Beside {
  const EstimatorResults& one;
  const EstimatorResults& best;
  double mean_of_best;
  const std::string& metric;
  const BootstrapOptions& bootstrap;
  const std::set<TrialKey>& trials;

  std::optional<Interval> minus(double times_best) const {
    const auto difference = difference_between(one, best, metric, bootstrap, times_best, &trials);
    return difference ? difference->interval : std::nullopt;
  }
};

// Two one-sided tests, at either end of the margin.
bool is_equivalent(const Beside& beside, const Interval& difference, double share, double digits) {
  if (difference.low >= -digits && difference.high <= digits) return true;
  const double mean = beside.mean_of_best;
  if (difference.low > share * std::abs(mean) || difference.high < -share * std::abs(mean)) {
    return false;
  }
  const double sign = mean < 0.0 ? -1.0 : 1.0;
  const auto above = beside.minus(1.0 + sign * share);
  const auto below = beside.minus(1.0 - sign * share);
  return above && below && above->high <= 0.0 && below->low >= 0.0;
}

Standing standing_of(const RankedEstimator& one, const Beside& beside, double share,
                     double margin) {
  const auto& difference = one.difference;
  if (!difference || !difference->interval) return Standing::not_shown;
  const Metric metric = described(beside.metric);
  if (is_equivalent(beside, *difference->interval, share, least_difference(beside.metric))) {
    return Standing::equivalent;
  }
  const double worse_by = metric.better == Better::lower ? difference->mean : -difference->mean;
  const bool is_beyond = worse_by > margin && difference->is_on_one_side();
  return one.p && *one.p < kError && is_beyond ? Standing::worse : Standing::not_shown;
}

std::size_t draws_of(const CellResults& cell, const std::set<TrialKey>& trials) {
  std::set<std::size_t> surveys;
  for (const TrialKey& trial : trials) surveys.insert(trial.survey);
  if (cell.repetition == Repetition::surveys && surveys.size() < 2) return 1;
  return surveys.size() > 1 ? surveys.size() : trials.size();
}

// Whether the trials, of one survey, repeat one log of each estimator.
bool repeats_one_log(const Contenders& compared) {
  if (compared.trials.size() < 2) return false;
  return std::ranges::all_of(compared.order, [&](const Contender& entry) {
    std::set<std::pair<std::size_t, std::string>> logs;
    for (const RunRecord& run : entry.one->runs) {
      if (compared.trials.contains(run.key.trial_key())) logs.emplace(run.key.survey, run.log_hash);
    }
    return logs.size() == 1 && !logs.begin()->second.empty();
  });
}

// Nobody is the best by rounding: of those that are as good the first of the study, whose
// estimators lie one behind the other.
void put_first_of_equals_first(std::vector<Contender>& order, const std::string& metric) {
  const double most = least_difference(metric);
  const auto end = std::ranges::find_if(order, [&, best = order.front().mean](const auto& one) {
    return std::abs(one.mean - best) > most;
  });
  const auto first = std::ranges::min_element(order.begin(), end, {}, &Contender::one);
  std::rotate(order.begin(), first, first + 1);
}

// Whether the log tells what registrations share, and one does not estimate it.
bool has_other_cost(const EstimatorResults& one) {
  const auto found = one.consistency.find("estimates_shared_errors");
  return found != one.consistency.end() && found->second.moments.mean < 1.0;
}

}  // namespace

double least_difference(const std::string& metric) {
  const std::string unit = described(metric).unit;
  if (unit == "m" || unit == "rad") return 1e-6;
  if (unit == "ms" || unit.empty()) return 1e-3;
  return 0.0;
}

const RankedEstimator* Ranking::find(const std::string& estimator) const {
  const auto found = std::ranges::find(estimators, estimator, &RankedEstimator::name);
  return found == estimators.end() ? nullptr : &*found;
}

std::vector<const RankedEstimator*> Ranking::standing(Standing which) const {
  std::vector<const RankedEstimator*> list;
  for (const RankedEstimator& one : estimators) {
    if (one.standing == which) list.push_back(&one);
  }
  return list;
}

std::size_t fewest_draws(std::size_t estimators) {
  const double pairs =
      0.5 * static_cast<double>(estimators) * (static_cast<double>(estimators) - 1);
  // The least p of n differences is 2^(1 − n).
  std::size_t draws = 2;
  while (pairs * std::exp2(1.0 - static_cast<double>(draws)) >= kError) ++draws;
  return draws;
}

bool is_of_optimum(const std::string& metric) {
  return metric == "chi2" || metric == "chi2_gap";
}

std::string no_ranking_text(const CellResults& cell, const std::string& metric) {
  if (!is_of_optimum(metric)) return "";
  const auto per_degree = optimum_per_degree(cell);
  if (is_misfit(per_degree)) {
    return "where measurements do not fit each other (F per degree of freedom " +
           format_number(*per_degree, 3) +
           " at its best), F is least of an estimator that keeps all loops, false ones too";
  }
  if (std::ranges::any_of(cell.estimators, has_other_cost)) {
    return "registrations share errors, and F with them is not what all estimators minimise";
  }
  return "";
}

std::string no_ranking_text(const StudyResults& results, const std::string& metric) {
  for (const CellResults& cell : results.cells) {
    if (std::string text = no_ranking_text(cell, metric); !text.empty()) return text;
  }
  return "";
}

std::optional<Ranking> ranking(const CellResults& cell, const std::string& metric,
                               const RankingOptions& options) {
  Contenders compared = contenders_of(cell, metric, options.names);
  const std::vector<Contender>& order = compared.order;
  if (order.empty()) return std::nullopt;
  if (!described(metric).is_cost) put_first_of_equals_first(compared.order, metric);
  Ranking result;
  result.metric = metric;
  result.left_out = compared.left_out;
  result.trials = compared.trials;
  const std::size_t differences = std::max<std::size_t>(1, order.size() - 1);
  result.level = 1.0 - kError / static_cast<double>(differences);
  result.margin = std::max(options.margin * std::abs(order.front().mean), least_difference(metric));
  result.draws = draws_of(cell, compared.trials);
  result.fewest_draws = fewest_draws(order.size());
  // The ends of a wider interval are in the tail, where more resamples are needed.
  const BootstrapOptions bootstrap{.probability = result.level,
                                   .resamples = kResamples * std::min<std::size_t>(3, differences)};
  const auto p = p_values(compared, metric);
  const EstimatorResults& best = *order.front().one;
  std::size_t most_draws = 1;
  for (std::size_t i = 0; i < order.size(); ++i) {
    RankedEstimator entry{order[i].one->name, summary_over(*order[i].one, metric, result.trials),
                          std::nullopt, p[i], i == 0 ? Standing::best : Standing::not_shown};
    if (i > 0)
      entry.difference =
          difference_between(*order[i].one, best, metric, bootstrap, 1.0, &compared.trials);
    if (entry.difference) most_draws = std::max(most_draws, entry.difference->count);
    result.estimators.push_back(std::move(entry));
  }
  if (order.size() > 1) {
    result.repeats_one_result = most_draws == 1 && repeats_one_log(compared);
    result.draws = std::min(result.draws, most_draws);
  }
  for (std::size_t i = 1; i < order.size() && result.gives_verdict(); ++i) {
    const Beside beside{*order[i].one, best,      order.front().mean,
                        metric,        bootstrap, compared.trials};
    RankedEstimator& entry = result.estimators[i];
    entry.standing = standing_of(entry, beside, options.margin, result.margin);
  }
  return result;
}

RankingMetric ranking_metric(const StudyResults& results) {
  RankingMetric found;
  for (const std::string& name : results.study.metrics) {
    const Metric metric = described(name);
    if (metric.is_cost || metric.better == Better::neither) continue;
    const bool occurs = std::ranges::any_of(results.cells, [&](const CellResults& cell) {
      return std::ranges::any_of(cell.estimators,
                                 [&](const auto& one) { return is_ranked(one, name); });
    });
    const std::string against = no_ranking_text(results, name);
    if (occurs && against.empty()) {
      found.name = name;
      return found;
    }
    if (occurs) found.passed_over.push_back("Not ranked by " + metric.label + ": " + against + ".");
  }
  return found;
}

}  // namespace fathom

#include "verdict.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

#include "contenders.hpp"
#include "difference_scales.hpp"
#include "fathom/core/text.hpp"
#include "fathom/report/table.hpp"
#include "regime_map.hpp"
#include "scaled_unit.hpp"
#include "verdict_answer.hpp"
#include "verdict_failures.hpp"

namespace fathom {
namespace {

std::string mean_text(const MetricSummary& summary, const std::string& unit) {
  return quantity(summary.moments.mean, summary.interval, unit);
}

// "+0.002 mm [-0.02, 0.03]": with its sign, as its interval may hold 0. What means nothing has no
// digits.
std::string signed_text(const RankedEstimator& one, const ScaledUnit& scale,
                        const std::string& metric) {
  const PairedDifference& difference = *one.difference;
  const double least = least_difference(metric);
  if (difference.interval->low >= -least && difference.interval->high <= least) {
    return "less than " + quantity(least, described(metric).unit);
  }
  std::string text = quantity(difference.mean, difference.interval, scale);
  if (difference.mean > 0.0) text.insert(text.starts_with("(") ? 1 : 0, "+");
  return text;
}

std::string share_text(const RankedEstimator& one, const Ranking& ranking) {
  const double best = std::abs(ranking.best().summary.moments.mean);
  if (!(best > 0.0)) return "";
  return " (" + format_number(100.0 * std::abs(one.difference->mean) / best, 2) + " % of the best)";
}

std::vector<const RankedEstimator*> with_interval(const Ranking& ranking, Standing standing) {
  std::vector<const RankedEstimator*> list = ranking.standing(standing);
  std::erase_if(list,
                [](const auto* one) { return !one->difference || !one->difference->interval; });
  return list;
}

// Those of one standing, each in words of its own.
template <typename Words>
std::string listed_with(const std::vector<const RankedEstimator*>& named, const Words& words) {
  std::vector<std::string> texts;
  texts.reserve(named.size());
  for (const RankedEstimator* one : named) texts.push_back(words(*one));
  return listed(texts);
}

void add_others(const Ranking& ranking, const std::string& unit,
                std::vector<std::string>& sentences) {
  const std::string& best = ranking.best().name;
  if (const auto named = with_interval(ranking, Standing::equivalent); !named.empty()) {
    const DifferenceScales scales(named, unit);
    sentences.push_back(fmt::format(
        "Equivalent to {}, within {}: {}.", best,
        quantity(ranking.margin, std::nullopt, reading_unit(unit, ranking.margin)),
        listed_with(named, [&](const RankedEstimator& one) {
          return fmt::format("{} ({})", one.name, signed_text(one, scales.of(one), ranking.metric));
        })));
    sentences.push_back(rare_text(ranking.draws));
  }
  if (const auto named = with_interval(ranking, Standing::not_shown); !named.empty()) {
    const DifferenceScales scales(named, unit);
    sentences.push_back(
        (ranking.gives_verdict() ? "Not shown to differ from " : "Differences to ") + best + ": " +
        listed_with(named,
                    [&](const RankedEstimator& one) {
                      const std::string p =
                          ranking.gives_verdict() && one.p ? ", p " + format_number(*one.p, 2) : "";
                      return fmt::format("{} ({}{})", one.name,
                                         signed_text(one, scales.of(one), ranking.metric), p);
                    }) +
        ".");
  }
  if (const auto named = with_interval(ranking, Standing::worse); !named.empty()) {
    const DifferenceScales scales(named, unit);
    sentences.push_back("Worse: " +
                        listed_with(named,
                                    [&](const RankedEstimator& one) {
                                      return fmt::format("{} by {}{}, p {}", one.name,
                                                         distance_text(one, scales.of(one)),
                                                         share_text(one, ranking),
                                                         format_number(*one.p, 2));
                                    }) +
                        ".");
  }
}

// One trial has no interval: the means alone.
void add_means(const Ranking& ranking, const std::string& unit,
               std::vector<std::string>& sentences) {
  std::vector<std::string> others;
  for (const RankedEstimator& one : ranking.estimators) {
    const bool has_interval = one.difference && one.difference->interval;
    if (&one == &ranking.best() || has_interval) continue;
    others.push_back(one.name + " " + mean_text(one.summary, unit));
  }
  if (!others.empty()) sentences.push_back("Not compared by an interval: " + listed(others) + ".");
}

void add_left_out(const Ranking& ranking, const std::string& label,
                  std::vector<std::string>& sentences) {
  for (const PartlyMeasured& one : ranking.left_out) {
    sentences.push_back(fmt::format("{} has no {} in {} of {} and is not ranked by it.", one.name,
                                    label, one.without, counted(one.trials, "trial")));
  }
}

// Over the trials that are ranked.
std::string baseline_text(const CellResults& cell, const Ranking& ranking) {
  const auto baseline = std::ranges::find(cell.estimators, kDeadReckoning, &EstimatorResults::name);
  if (baseline == cell.estimators.end()) return "";
  std::set<TrialKey> trials = trials_with(*baseline, ranking.metric);
  std::erase_if(trials, [&](const TrialKey& trial) { return !ranking.trials.contains(trial); });
  if (trials.empty()) return "";
  const Metric metric = described(ranking.metric);
  const double mean = mean_over(*baseline, metric.name, trials);
  const double best = ranking.best().summary.moments.mean;
  std::string text = "Dead reckoning: " + quantity(mean, metric.unit);
  if (metric.better == Better::lower && best > 0.0 && trials == ranking.trials) {
    text += ", " + format_number(mean / best, 2) + " times the lowest";
  }
  return text + ".";
}

std::vector<std::string> answer_of(const CellResults& cell, const std::optional<Ranking>& ranking,
                                   const std::string& by) {
  if (!ranking) return {nobody_is_ranked_text(cell, by)};
  const Metric metric = described(ranking->metric);
  const RankedEstimator& best = ranking->best();
  const std::string mean = fmt::format("{}, {}.", best.name, mean_text(best.summary, metric.unit));
  const char* which = metric.better == Better::lower ? "Lowest " : "Highest ";
  std::vector<std::string> sentences{
      fmt::format("{}{}: {}", ranking->estimators.size() == 1 ? "Only one is ranked by " : which,
                  metric.label, mean)};
  if (ranking->estimators.size() > 1 && !ranking->gives_verdict()) {
    sentences.push_back(no_verdict_text(*ranking, cell));
  }
  add_others(*ranking, metric.unit, sentences);
  add_means(*ranking, metric.unit, sentences);
  add_left_out(*ranking, metric.label, sentences);
  if (const auto text = baseline_text(cell, *ranking); !text.empty()) sentences.push_back(text);
  return sentences;
}

std::string cost_text(const Ranking& by_cost) {
  const Metric metric = described(by_cost.metric);
  const MetricSummary& least = by_cost.best().summary;
  // One unit for the sentence, as it compares.
  double most =
      least.interval ? std::max(least.moments.mean, least.interval->high) : least.moments.mean;
  for (const RankedEstimator& one : by_cost.estimators) {
    most = std::max(most, one.summary.moments.mean);
  }
  const ScaledUnit unit = reading_unit(metric.unit, most);
  std::string text =
      fmt::format("Cheapest of those within 5 % of the best: {}, {} {}.", by_cost.best().name,
                  metric.label, quantity(least.moments.mean, least.interval, unit));
  const auto add = [&](Standing standing, const std::string& before, const std::string& after) {
    std::vector<std::string> named;
    for (const RankedEstimator* one : by_cost.standing(standing)) {
      named.push_back(one->name + " " + quantity(one->summary.moments.mean, std::nullopt, unit));
    }
    if (!named.empty()) text += before + listed(named) + after;
  };
  add(Standing::equivalent, " As cheap: ", ".");
  add(Standing::not_shown, " Not shown to be dearer: ", ".");
  add(Standing::worse, " Dearer: ", ".");
  return text;
}

}  // namespace

std::string listed(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t i = 0; i < names.size(); ++i) {
    if (i > 0) text += i + 1 == names.size() ? " and " : ", ";
    text += names[i];
  }
  return text;
}

std::vector<std::string> before_ranking(const RankingMetric& by) {
  if (by.name || !by.passed_over.empty()) return by.passed_over;
  return {"Not ranked: no metric of this study that says which is better has a value."};
}

CellVerdict cell_verdict(const CellResults& cell, const StudyDescription& study,
                         const RankingMetric& by, const std::optional<std::string>& cost) {
  CellVerdict verdict;
  verdict.answer = before_ranking(by);
  if (by.name) {
    verdict.ranking = ranking(cell, *by.name, {.margin = study.margin});
    const std::vector<std::string> answer = answer_of(cell, verdict.ranking, *by.name);
    verdict.answer.insert(verdict.answer.end(), answer.begin(), answer.end());
  }
  if (verdict.ranking && cost) {
    const std::vector<std::string> good = as_good_as_best(cell, *by.name);
    if (!good.empty()) verdict.by_cost = ranking(cell, *cost, {good, study.margin});
  }
  if (verdict.by_cost) {
    verdict.cost = {cost_text(*verdict.by_cost)};
    for (const RankedEstimator& one : verdict.by_cost->estimators) {
      const bool is_dearer = one.standing == Standing::worse;
      if (&one != &verdict.by_cost->best() && !is_dearer) verdict.as_cheap.push_back(one.name);
    }
  }
  verdict.failed = failures_of(cell, study);
  verdict.doubts = doubts_of(cell, verdict);
  return verdict;
}

}  // namespace fathom

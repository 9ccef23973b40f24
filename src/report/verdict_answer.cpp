#include "verdict_answer.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <map>

#include "fathom/report/table.hpp"
#include "scaled_unit.hpp"

namespace fathom {
namespace {

// An estimator in the cell where it is furthest from the best.
struct Worst {
  std::size_t cells = 0;
  const RankedEstimator* one = nullptr;
  const CellResults* cell = nullptr;
  double share = 0.0;
};

void add_worse(const StudyResults& results, StudyVerdict& verdict) {
  std::map<std::string, Worst> worst;
  for (std::size_t i = 0; i < results.cells.size(); ++i) {
    const auto& ranking = verdict.cells[i].ranking;
    if (!ranking) continue;
    for (const RankedEstimator* one : ranking->standing(Standing::worse)) {
      const double best = std::abs(ranking->best().summary.moments.mean);
      const double share = best > 0.0 ? std::abs(one->difference->mean) / best : 0.0;
      Worst& entry = worst[one->name];
      ++entry.cells;
      if (entry.one == nullptr || share > entry.share) {
        entry = {entry.cells, one, &results.cells[i], share};
      }
    }
  }
  // The furthest first.
  std::vector<std::pair<std::string, Worst>> order(worst.begin(), worst.end());
  std::ranges::stable_sort(
      order, [](const auto& a, const auto& b) { return a.second.share > b.second.share; });
  for (const auto& [name, entry] : order) {
    const std::string in = of_cells(entry.cells, results.cells.size());
    const double furthest = std::max(std::abs(entry.one->difference->interval->low),
                                     std::abs(entry.one->difference->interval->high));
    const ScaledUnit scale = reading_unit(described(*verdict.metric).unit, furthest);
    verdict.answer.push_back(fmt::format(
        "{} is worse in {}, most at {}: by {}, {} % of the best.", name, in, entry.cell->label,
        distance_text(*entry.one, scale), format_number(100.0 * entry.share, 2)));
  }
}

// In how many cells each is equivalent to another that is the best.
void add_equivalent(const StudyResults& results, StudyVerdict& verdict) {
  std::map<std::string, std::size_t> cells;
  std::size_t fewest_draws = std::numeric_limits<std::size_t>::max();
  for (const CellVerdict& cell : verdict.cells) {
    if (!cell.ranking) continue;
    for (const RankedEstimator* one : cell.ranking->standing(Standing::equivalent)) {
      ++cells[one->name];
      fewest_draws = std::min(fewest_draws, cell.ranking->draws);
    }
  }
  if (cells.empty()) return;
  std::vector<std::string> parts;
  parts.reserve(cells.size());
  for (const auto& [name, count] : cells) {
    parts.push_back(name + " in " + of_cells(count, results.cells.size()));
  }
  verdict.answer.push_back("Equivalent to the best: " + listed(parts) + ".");
  verdict.answer.push_back(rare_text(fewest_draws));
}

// Who lacks the metric in trials in which others have it.
void add_partly_measured(const StudyResults& results, StudyVerdict& verdict) {
  std::map<std::string, std::size_t> cells;
  for (const CellVerdict& cell : verdict.cells) {
    if (!cell.ranking) continue;
    for (const PartlyMeasured& one : cell.ranking->left_out) ++cells[one.name];
  }
  for (const auto& [name, count] : cells) {
    verdict.answer.push_back(
        fmt::format("{} has no {} in some trials of {}, where it is not ranked by it.", name,
                    described(*verdict.metric).label, of_cells(count, results.cells.size())));
  }
}

}  // namespace

std::string distance_text(const RankedEstimator& one, const ScaledUnit& scale) {
  const PairedDifference& difference = *one.difference;
  std::optional<Interval> interval = difference.interval;
  if (interval && difference.mean < 0.0) interval = Interval{-interval->high, -interval->low};
  return quantity(std::abs(difference.mean), interval, scale);
}

std::string no_verdict_text(const Ranking& ranking, const CellResults& cell) {
  if (ranking.repeats_one_result) {
    return fmt::format("No verdict: the {} have the same measurements and are one result.",
                       counted(ranking.trials.size(), "trial"));
  }
  const bool is_of_surveys = cell.repetition == Repetition::surveys || cell.surveys > 1;
  return fmt::format("No verdict: with {} no difference between {} can be shown; {} are needed.",
                     counted(ranking.draws, is_of_surveys ? "survey" : "trial"),
                     counted(ranking.estimators.size(), "estimator"), ranking.fewest_draws);
}

std::string rare_text(std::size_t draws) {
  // What has a probability of 3 / n occurs in none of n draws with one of 5 %.
  return fmt::format("{} draws need not show what goes wrong in one of {}.", draws,
                     format_number(static_cast<double>(draws) / 3.0, 2));
}

std::string of_cells(std::size_t count, std::size_t all) {
  return count == all ? "all " + std::to_string(all) + " cells"
                      : fmt::format("{} of {} cells", count, all);
}

void add_answer(const StudyResults& results, StudyVerdict& verdict) {
  const std::size_t all = results.cells.size();
  if (!verdict.metric) return;
  std::size_t compared = 0;
  std::size_t decided = 0;
  std::size_t differing = 0;
  std::size_t most_needed = 0;
  for (std::size_t i = 0; i < all; ++i) {
    const auto& ranking = verdict.cells[i].ranking;
    const bool has_interval =
        ranking && std::ranges::any_of(ranking->estimators, [](const auto& one) {
          return one.difference && one.difference->interval;
        });
    if (!has_interval) continue;
    ++compared;
    decided += ranking->gives_verdict() ? 1 : 0;
    differing += ranking->standing(Standing::worse).empty() ? 0 : 1;
    if (!ranking->gives_verdict()) most_needed = std::max(most_needed, ranking->fewest_draws);
  }
  const std::string label = described(*verdict.metric).label;
  if (compared == 0) {
    verdict.answer.push_back("Estimators are ranked by " + label +
                             ", but no cell has an interval of a difference.");
  }
  if (decided > 0) {
    verdict.answer.push_back(differing == 0
                                 ? fmt::format("In {} no estimator is shown to be worse than the "
                                               "best by {}.",
                                               of_cells(decided, all), label)
                                 : fmt::format("By {} an estimator is worse than the best in {}.",
                                               label, of_cells(differing, all)));
  }
  if (decided < compared) {
    verdict.answer.push_back(fmt::format(
        "No verdict by {} in {}: no difference can be shown with so few surveys, or trials of "
        "drawn measurements; up to {} are needed.",
        label, of_cells(compared - decided, all), most_needed));
  }
  add_equivalent(results, verdict);
  add_worse(results, verdict);
  add_partly_measured(results, verdict);
}

}  // namespace fathom

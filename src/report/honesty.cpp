#include "honesty.hpp"

#include <algorithm>
#include <set>

#include "fathom/core/chi_squared.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "study_results.hpp"

namespace fathom {
namespace {

constexpr double kProbability = 0.95;
constexpr const char* kRelative = "relative_anees_";

// Where a figure lies beside what is expected of honest covariances.
enum class Level { unknown, low, expected, high };

Level level_of(const MetricSummary& summary, double expected, const Interval& chance) {
  const double ratio = summary.moments.mean / expected;
  const auto& interval = summary.interval;
  if (ratio > chance.high && (!interval || interval->low > expected)) return Level::high;
  if (ratio < chance.low && (!interval || interval->high < expected)) return Level::low;
  return Level::expected;
}

// 0 where they are not known.
double degrees_of_freedom(const std::map<std::string, MetricSummary>& figures) {
  const auto mean = [&figures](const char* metric) {
    const auto found = figures.find(metric);
    return found == figures.end() ? 0.0 : found->second.moments.mean;
  };
  // Where the metric is not there, it is three times the registrations.
  const double degrees = figures.contains("degrees_of_freedom") ? mean("degrees_of_freedom")
                                                                : 3.0 * mean("registrations");
  return std::max(0.0, degrees);
}

class Figures {
 public:
  Figures(const std::map<std::string, MetricSummary>& figures, std::size_t draws,
          bool considers_shared_errors)
      : figures_(figures), draws_(draws), considers_shared_errors_(considers_shared_errors) {}

  const MetricSummary* find(const std::string& metric) const {
    const auto found = figures_.find(metric);
    return found == figures_.end() ? nullptr : &found->second;
  }

  // Of a figure that errors which are the same everywhere leave with 3 degrees of freedom a draw.
  Level level(const std::string& metric, double expected) const {
    const MetricSummary* summary = find(metric);
    if (summary == nullptr || draws_ == 0) return Level::unknown;
    return level_of(*summary, expected, anees_interval(draws_, 3, kProbability));
  }

  // Of the motions over any stretch: high where one of them is.
  bool is_any_motion_high() const {
    return std::ranges::any_of(figures_, [&](const auto& figure) {
      return figure.first.starts_with(kRelative) && level(figure.first, 1.0) == Level::high;
    });
  }

  Level level_of_cost() const {
    const MetricSummary* summary = find("chi2_per_dof");
    const auto dof = static_cast<std::size_t>(degrees_of_freedom(figures_));
    if (summary == nullptr || dof == 0 || draws_ == 0) return Level::unknown;
    return level_of(*summary, 1.0, anees_interval(draws_, dof, kProbability));
  }

  bool is_off_the_optimum() const {
    return fathom::is_off_the_optimum(figures_, considers_shared_errors_);
  }

  bool is_correlated() const {
    const MetricSummary* summary = find("picture_error_correlation");
    return summary != nullptr && summary->interval && summary->interval->low > 0.0;
  }

 private:
  const std::map<std::string, MetricSummary>& figures_;
  std::size_t draws_ = 0;
  bool considers_shared_errors_ = false;
};

// Why covariances are too small, by the figure that says most.
void explain_high(const Figures& figures, Honesty& honesty) {
  const Level cost = figures.level_of_cost();
  const Level nis = figures.level("mean_nis_truth", 3.0);
  honesty.agrees_too_well = cost == Level::low;
  honesty.is_correlated = figures.is_correlated();
  if (figures.is_off_the_optimum()) {
    honesty.cause = HonestyCause::off_the_optimum;
  } else if (figures.level("anchored_anees", 1.0) == Level::expected &&
             !figures.is_any_motion_high()) {
    honesty.cause = HonestyCause::first_picture;
  } else if (honesty.agrees_too_well || honesty.is_correlated) {
    honesty.cause = HonestyCause::shared_errors;
  } else if (nis == Level::high) {
    honesty.cause = HonestyCause::small_registrations;
  } else if (nis == Level::expected) {
    honesty.cause = HonestyCause::linearisation;
  } else if (cost == Level::high) {
    honesty.cause = HonestyCause::misfit;
  }
}

}  // namespace

bool is_of_honesty(const std::string& metric) {
  static const std::set<std::string> metrics{"anees",
                                             "anchored_anees",
                                             "mean_nis_truth",
                                             "picture_error_correlation",
                                             "chi2_per_dof",
                                             "registrations",
                                             "chi2_gap",
                                             "chi2_optimum",
                                             "degrees_of_freedom",
                                             "holes",
                                             "estimates_shared_errors"};
  return metrics.contains(metric) || metric.starts_with(kRelative);
}

std::optional<double> optimum_per_degree(const std::map<std::string, MetricSummary>& figures) {
  const auto optimum = figures.find("chi2_optimum");
  const double degrees = degrees_of_freedom(figures);
  if (optimum == figures.end() || !(degrees > 0.0)) return std::nullopt;
  return optimum->second.moments.mean / degrees;
}

std::optional<double> optimum_per_degree(const CellResults& cell) {
  std::optional<double> least;
  for (const EstimatorResults& one : cell.estimators) {
    const auto own = optimum_per_degree(one.consistency);
    if (own && !(least && *least <= *own)) least = own;
  }
  return least;
}

// A true error of one pose has a χ² of 3 degrees of freedom. Beyond that, whatever the draws, the
// estimate is not where the measurements put it. By the median, too: of gaps of many sizes the
// greatest widen the interval of the mean to below zero. Honest errors of two or more runs have
// such a median in 0.5 % of cells at most.
bool is_off_the_optimum(const std::map<std::string, MetricSummary>& figures,
                        bool considers_shared_errors) {
  if (is_misfit(optimum_per_degree(figures))) return false;
  const auto found = figures.find("chi2_gap");
  double most = chi_squared_quantile(0.5 * (1.0 + kProbability), 3.0);
  // Of a log that tells none, all are equal.
  if (considers_shared_errors && figures.contains("estimates_shared_errors")) {
    const double scale = std::max(1.0, optimum_per_degree(figures).value_or(1.0));
    most = std::max(most, 3.0 * scale * degrees_of_freedom(figures));
  }
  if (found == figures.end() || !found->second.interval) return false;
  return found->second.interval->low > most || found->second.moments.median > most;
}

std::optional<Honesty> honesty_of(const std::map<std::string, MetricSummary>& figures,
                                  std::size_t draws, bool considers_shared_errors) {
  const Figures known(figures, draws, considers_shared_errors);
  const Level level = known.level("anees", 1.0);
  if (level != Level::high && level != Level::low) return std::nullopt;
  Honesty honesty;
  if (const MetricSummary* estimates = known.find("estimates_shared_errors")) {
    honesty.is_told = true;
    honesty.estimates_shared_errors = estimates->moments.mean > 0.5;
  }
  honesty.is_overconfident = level == Level::high;
  if (honesty.is_overconfident) {
    explain_high(known, honesty);
  } else if (known.level("mean_nis_truth", 3.0) == Level::low) {
    honesty.cause = HonestyCause::large_registrations;
  } else if (known.find("holes") != nullptr) {
    honesty.cause = HonestyCause::holes;
  }
  return honesty;
}

}  // namespace fathom

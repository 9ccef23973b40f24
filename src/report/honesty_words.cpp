#include "honesty_words.hpp"

#include <algorithm>
#include <optional>
#include <set>

#include "fathom/core/chi_squared.hpp"
#include "fathom/evaluation/consistency.hpp"
#include "fathom/report/table.hpp"

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

std::string text_of(const MetricSummary& summary) {
  constexpr int kDigits = 2;
  const std::string mean = format_number(summary.moments.mean, kDigits);
  if (!summary.interval) return mean;
  return mean + " [" + format_number(summary.interval->low, kDigits) + ", " +
         format_number(summary.interval->high, kDigits) + "]";
}

class Figures {
 public:
  Figures(const std::map<std::string, MetricSummary>& figures, std::size_t draws)
      : figures_(figures), draws_(draws) {}

  const MetricSummary* find(const std::string& metric) const {
    const auto found = figures_.find(metric);
    return found == figures_.end() ? nullptr : &found->second;
  }

  std::string text(const std::string& metric) const { return text_of(*find(metric)); }

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
    const MetricSummary* registrations = find("registrations");
    const MetricSummary* degrees = find("degrees_of_freedom");
    if (summary == nullptr || registrations == nullptr || draws_ == 0) return Level::unknown;
    const auto dof = static_cast<std::size_t>(std::max(
        0.0, degrees != nullptr ? degrees->moments.mean : 3.0 * registrations->moments.mean));
    if (dof == 0) return Level::unknown;
    return level_of(*summary, 1.0, anees_interval(draws_, dof, kProbability));
  }

  bool is_off_the_optimum() const { return fathom::is_off_the_optimum(figures_); }

  bool is_correlated() const {
    const MetricSummary* summary = find("picture_error_correlation");
    return summary != nullptr && summary->interval && summary->interval->low > 0.0;
  }

 private:
  const std::map<std::string, MetricSummary>& figures_;
  std::size_t draws_ = 0;
};

// Why covariances are too small, by the figure that says most; empty where none does.
std::string cause_of_high(const Figures& figures) {
  const Level cost = figures.level_of_cost();
  const Level nis = figures.level("mean_nis_truth", 3.0);
  if (figures.is_off_the_optimum()) {
    return "The estimate is not at the optimum of the measurements: its F is above it by " +
           figures.text("chi2_gap") + ", by its linearisation or a wrong minimum.";
  }
  if (figures.level("anchored_anees", 1.0) == Level::expected && !figures.is_any_motion_high()) {
    return "With other keyframes held it is " + figures.text("anchored_anees") +
           ": what is wrong is the first picture, from which every pose is measured.";
  }
  if (cost == Level::low || figures.is_correlated()) {
    std::string text = "The registrations share errors: ";
    if (cost == Level::low) {
      text +=
          "they agree with one another better than their covariances say (F per degree of "
          "freedom " +
          figures.text("chi2_per_dof") + ")";
    }
    if (figures.is_correlated()) {
      text += std::string(cost == Level::low ? ", and " : "") +
              "those of one picture have errors with correlation " +
              figures.text("picture_error_correlation");
    }
    return text + "; estimators take them as independent.";
  }
  if (nis == Level::high) {
    return "The covariances of the registrations are too small: their mean NIS against truth is " +
           figures.text("mean_nis_truth") + ", where 3 is expected.";
  }
  if (nis == Level::expected) {
    return "The covariances of the registrations are right against truth (mean NIS " +
           figures.text("mean_nis_truth") +
           ", 3 expected): what is too small is the estimator's own, as linearisation leaves it.";
  }
  if (cost == Level::high) {
    return "F per degree of freedom is " + figures.text("chi2_per_dof") +
           ": covariances of the log are too small, or loops are false.";
  }
  return "";
}

std::string cause_of_low(const Figures& figures) {
  if (figures.level("mean_nis_truth", 3.0) != Level::low) return "";
  return "The covariances of the registrations are too large: their mean NIS against truth is " +
         figures.text("mean_nis_truth") + ", where 3 is expected.";
}

}  // namespace

bool is_of_words(const std::string& metric) {
  static const std::set<std::string> metrics{
      "anees",        "anchored_anees", "mean_nis_truth", "picture_error_correlation",
      "chi2_per_dof", "registrations",  "chi2_gap",       "degrees_of_freedom"};
  return metrics.contains(metric) || metric.starts_with(kRelative);
}

// A true error of one pose has a χ² of 3 degrees of freedom. Beyond that, whatever the draws, the
// estimate is not where the measurements put it.
bool is_off_the_optimum(const std::map<std::string, MetricSummary>& figures) {
  const auto found = figures.find("chi2_gap");
  const double most = chi_squared_quantile(0.5 * (1.0 + kProbability), 3.0);
  return found != figures.end() && found->second.interval && found->second.interval->low > most;
}

std::vector<std::string> honesty_words(const std::map<std::string, MetricSummary>& figures,
                                       std::size_t draws) {
  const Figures known(figures, draws);
  const Level level = known.level("anees", 1.0);
  if (level != Level::high && level != Level::low) return {};
  const bool is_high = level == Level::high;
  std::vector<std::string> words{
      (is_high ? "Overconfident: ANEES is " : "Underconfident: ANEES is ") + known.text("anees") +
      ", where 1 is expected."};
  const std::string cause = is_high ? cause_of_high(known) : cause_of_low(known);
  if (!cause.empty()) words.push_back(cause);
  return words;
}

}  // namespace fathom

#include "deviance_search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

namespace fathom {
namespace {

constexpr double kDecade = 2.302585092994046;  // log 10
constexpr int kMaxSteps = 60;
constexpr int kMaxCuts = 12;
constexpr double kLongestStep = 1.5;  // of log σ: the deviance is no parabola over more

}  // namespace

DevianceSearch::DevianceSearch(RestrictedLikelihood& likelihood,
                               std::span<const VarianceComponent> components, double tolerance)
    : likelihood_(likelihood),
      tolerance_(tolerance),
      held_(components.size()),
      low_(likelihood.components()),
      high_(likelihood.components()) {
  for (Index j = 0; j < low_.size(); ++j) {
    high_[j] = std::log(components[static_cast<std::size_t>(j)].greatest());
    low_[j] = std::log(likelihood.negligible(j));
    held_[static_cast<std::size_t>(j)] = !(low_[j] < high_[j]);
  }
}

bool DevianceSearch::has_nothing() const {
  return std::ranges::all_of(held_, [](bool is) { return is; });
}

// What is told, within the box.
Eigen::VectorXd DevianceSearch::told() const {
  Eigen::VectorXd at(low_.size());
  for (Index j = 0; j < at.size(); ++j) {
    at[j] = is_held(j) ? std::numeric_limits<double>::quiet_NaN()
                       : std::clamp(std::log(likelihood_.told(j)), low_[j], high_[j]);
  }
  return at;
}

Eigen::VectorXd DevianceSearch::best_of_grid(Eigen::VectorXd at) {
  double least = likelihood_.deviance(at);
  for (Index j = 0; j < at.size(); ++j) {
    if (is_held(j)) continue;
    Eigen::VectorXd trial = at;
    for (int decade = 0; low_[j] + decade * kDecade < high_[j]; ++decade) {
      trial[j] = low_[j] + decade * kDecade;
      const double deviance = likelihood_.deviance(trial);
      if (!(deviance < least)) continue;
      least = deviance;
      at = trial;
    }
  }
  return at;
}

DevianceSearch::Optimum DevianceSearch::minimise_beyond_zero(Eigen::VectorXd at) {
  // The box of another log may have been wider.
  for (Index j = 0; j < at.size(); ++j) {
    at[j] = is_held(j) ? std::numeric_limits<double>::quiet_NaN()
                       : std::clamp(at[j], low_[j], high_[j]);
  }
  Optimum best = minimise(at);
  for (bool has_fallen = best.is_finite(); has_fallen;) {
    has_fallen = false;
    for (Index j = 0; j < at.size(); ++j) {
      if (is_held(j)) continue;
      at = best.log_sigma;
      at[j] = low_[j];
      std::vector<bool> held = held_;
      held[static_cast<std::size_t>(j)] = true;
      const Optimum without = minimise(at, held, 100.0 * tolerance_);
      if (!(without.fit.deviance < best.fit.deviance - 1000.0 * tolerance_)) continue;
      best = minimise(without.log_sigma);
      has_fallen = true;
    }
  }
  return best;
}

DevianceSearch::Optimum DevianceSearch::minimise(const Eigen::VectorXd& at,
                                                 const std::vector<bool>& held, double tolerance) {
  Optimum best{at, likelihood_.fit(at)};
  for (int step = 0; step < kMaxSteps && best.is_finite(); ++step) {
    Eigen::VectorXd move = step_of(best, held);
    if (-slope_along(best, move) < tolerance) break;
    bool has_fallen = false;
    for (int cut = 0; cut < kMaxCuts && !has_fallen; ++cut, move *= 0.5) {
      const Eigen::VectorXd trial = best.log_sigma + move;
      const double deviance = likelihood_.deviance(trial);
      if (!(deviance < best.fit.deviance + 0.1 * slope_along(best, move))) continue;
      best = {trial, likelihood_.fit(trial)};
      has_fallen = true;
    }
    if (!has_fallen) break;
  }
  return best;
}

// Down the slope, by the information of what is not held and not pressed against the box.
Eigen::VectorXd DevianceSearch::step_of(const Optimum& at, const std::vector<bool>& held) const {
  const Index count = low_.size();
  Eigen::VectorXd step = Eigen::VectorXd::Zero(count);
  Eigen::VectorXd slope = at.fit.slope;
  Eigen::MatrixXd information = at.fit.information;
  for (Index j = 0; j < count; ++j) {
    const bool is_pressed = (at.log_sigma[j] <= low_[j] && slope[j] > 0.0) ||
                            (at.log_sigma[j] >= high_[j] && slope[j] < 0.0);
    if (held[static_cast<std::size_t>(j)] || is_pressed) {
      slope[j] = 0.0;
      information.row(j).setZero();
      information.col(j).setZero();
    }
    if (slope[j] == 0.0) information(j, j) = 1.0;
  }
  const Eigen::VectorXd newton = -information.ldlt().solve(slope);
  for (Index j = 0; j < count; ++j) {
    if (slope[j] == 0.0) continue;
    const double wanted =
        std::isfinite(newton[j]) ? newton[j] : -std::copysign(kLongestStep, slope[j]);
    const double limited = std::clamp(wanted, -kLongestStep, kLongestStep);
    step[j] = std::clamp(at.log_sigma[j] + limited, low_[j], high_[j]) - at.log_sigma[j];
  }
  return step;
}

double DevianceSearch::slope_along(const Optimum& at, const Eigen::VectorXd& step) const {
  double sum = 0.0;
  for (Index j = 0; j < step.size(); ++j) {
    if (step[j] != 0.0) sum += at.fit.slope[j] * step[j];
  }
  return sum;
}

double DevianceSearch::rise(const Optimum& best, Index j, double log_sigma) {
  if (warm_.size() == 0) warm_ = best.log_sigma;
  Eigen::VectorXd at = warm_;
  at[j] = log_sigma;
  std::vector<bool> held = held_;
  held[static_cast<std::size_t>(j)] = true;
  const bool is_alone = std::ranges::all_of(held, [](bool is) { return is; });
  if (is_alone) return likelihood_.deviance(at) - best.fit.deviance;
  // An end of an interval is not met closer than to 1000 tolerances.
  const Optimum profile = minimise(at, held, 100.0 * tolerance_);
  warm_ = profile.log_sigma;
  return profile.is_finite() ? profile.fit.deviance - best.fit.deviance
                             : std::numeric_limits<double>::quiet_NaN();
}

// √rise − √level.
double DevianceSearch::beyond(const Optimum& best, Index j, double level, double log_sigma) {
  return std::sqrt(std::max(0.0, rise(best, j, log_sigma))) - std::sqrt(level);
}

// Steps that double until the profile is above the level.
std::optional<DevianceSearch::Bracket> DevianceSearch::bracket(const Optimum& best, Index j,
                                                               double level, double direction) {
  warm_ = best.log_sigma;
  const double last = direction < 0.0 ? low_[j] : high_[j];
  Bracket ends{best.log_sigma[j], 0.0, best.log_sigma[j], -std::sqrt(level)};
  double step = std::clamp(std::sqrt(2.0 * level / best.fit.information(j, j)), 0.01, kLongestStep);
  while (ends.f_outside < 0.0) {
    if (ends.outside == last) return std::nullopt;
    ends.inside = ends.outside;
    ends.f_inside = ends.f_outside;
    ends.outside =
        direction * std::min(direction * (ends.outside + direction * step), direction * last);
    ends.f_outside = beyond(best, j, level, ends.outside);
    step *= 2.0;
  }
  return ends;
}

// Regula falsi on the root of the rise, which is nearly straight in log σ, halving where that is
// slow (Illinois).
std::optional<double> DevianceSearch::end(const Optimum& best, Index j, double level,
                                          double direction) {
  const auto found = bracket(best, j, level, direction);
  if (!found) return std::nullopt;
  auto [inside, f_inside, outside, f_outside] = *found;
  double middle = outside;
  const double close = 500.0 * tolerance_ / std::sqrt(level);  // 1000 tolerances of the rise
  for (int i = 0; i < kMaxSteps && std::abs(outside - inside) > 1e-6; ++i) {
    middle = inside - f_inside * (outside - inside) / (f_outside - f_inside);
    const double f = beyond(best, j, level, middle);
    if (std::abs(f) < close) break;
    if (f > 0.0) {
      outside = middle;
      f_outside = f;
      f_inside *= 0.5;
    } else {
      inside = middle;
      f_inside = f;
      f_outside *= 0.5;
    }
  }
  return middle;
}

}  // namespace fathom

#pragma once

#include <optional>
#include <vector>

#include "restricted_likelihood.hpp"

namespace fathom {

/// The least deviance over a box of log σ, and where its profiles rise above a level.
/// Deterministic: a grid of one value a decade, then Newton steps with the average information,
/// each cut until the deviance falls. An evaluation that fails makes the search's results NaN.
class DevianceSearch {
 public:
  using Index = Eigen::Index;

  /// Components that do not respond are held as told.
  DevianceSearch(RestrictedLikelihood& likelihood, std::span<const VarianceComponent> components,
                 double tolerance);

  struct Optimum {
    Eigen::VectorXd log_sigma;
    RestrictedFit fit;

    bool is_finite() const { return fit.slope.size() > 0; }
  };

  /// The best value of a grid along each component, the others as in `at`.
  Eigen::VectorXd best_of_grid(Eigen::VectorXd at);
  /// From `at`, and again from where one component is 0, as long as that is better: another may
  /// explain what it did.
  Optimum minimise_beyond_zero(Eigen::VectorXd at);
  /// From `at`, until a step promises less than the tolerance; the components that are `held` stay.
  Optimum minimise(const Eigen::VectorXd& at, const std::vector<bool>& held, double tolerance);
  Optimum minimise(const Eigen::VectorXd& at) { return minimise(at, held_, tolerance_); }

  /// The deviance with component j held at log σ, less that of the best.
  double rise(const Optimum& best, Index j, double log_sigma);
  /// Two log σ beside the best one, between which the profile rises by `level` in direction ±1, and
  /// √rise − √level there; none where it does not rise so far within the box.
  struct Bracket {
    double inside;
    double f_inside;
    double outside;
    double f_outside;
  };
  std::optional<Bracket> bracket(const Optimum& best, Index j, double level, double direction);
  /// The log σ beside the best one where the profile rises by `level`, in direction ±1; none where
  /// it does not within the box.
  std::optional<double> end(const Optimum& best, Index j, double level, double direction);

  /// Whether all components are held.
  bool has_nothing() const;
  bool is_held(Index j) const { return held_[static_cast<std::size_t>(j)]; }
  /// Where σ does nothing any more, and 0 stands for it.
  double low(Index j) const { return low_[j]; }
  Eigen::VectorXd told() const;

 private:
  double beyond(const Optimum& best, Index j, double level, double log_sigma);
  Eigen::VectorXd step_of(const Optimum& at, const std::vector<bool>& held) const;
  double slope_along(const Optimum& at, const Eigen::VectorXd& step) const;

  RestrictedLikelihood& likelihood_;
  double tolerance_;
  std::vector<bool> held_;
  Eigen::VectorXd low_;
  Eigen::VectorXd high_;
  Eigen::VectorXd warm_;  // where the last profile point had the other components
};

}  // namespace fathom

#include "fathom/measurements/variance_components.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <exception>
#include <limits>
#include <string>
#include <utility>

#include "contradicted.hpp"
#include "deviance_search.hpp"
#include "fathom/core/chi_squared.hpp"
#include "fathom/core/workers.hpp"
#include "restricted_likelihood.hpp"
#include "variance_checks.hpp"

namespace fathom {
namespace {

void check(const MeasurementLog& log, std::span<const Pose> trajectory,
           std::span<const VarianceComponent> components, const VarianceOptions& options) {
  check_components(log, components);
  check_size(trajectory.size(), log.size(), "poses");
  if (!options.used.empty()) {
    check_size(options.used.size(), log.registration_count(), "marks of used registrations");
  }
}

// An optimum as good as 0, by so many tolerances of the search, is 0.
constexpr double kAsGoodAsZero = 100.0;

bool wants_intervals(const DevianceSearch::Optimum& best, const VarianceOptions& options) {
  const Eigen::VectorXd sigmas = best.log_sigma.array().exp();
  return !options.wants_intervals ||
         options.wants_intervals({sigmas.data(), static_cast<std::size_t>(sigmas.size())});
}

SigmaEstimate estimate_of(DevianceSearch& search, const RestrictedLikelihood& likelihood,
                          const DevianceSearch::Optimum& best, Eigen::Index j,
                          const VarianceOptions& options) {
  SigmaEstimate estimate;
  estimate.pictures = likelihood.pictures(j);
  if (search.is_held(j)) return estimate;
  const double level = chi_squared_quantile(options.probability, 1.0);
  if (!wants_intervals(best, options)) {
    constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
    const auto beyond = search.bracket(best, j, level, 1.0);
    const double high = beyond ? std::exp(beyond->outside) : estimate.high;
    return {std::exp(best.log_sigma[j]), kNaN, high, kNaN, kNaN, estimate.pictures};
  }
  if (const auto low = search.end(best, j, level, -1.0)) estimate.low = std::exp(*low);
  if (const auto high = search.end(best, j, level, 1.0)) estimate.high = std::exp(*high);
  estimate.against_told = search.rise(best, j, std::numeric_limits<double>::quiet_NaN());
  estimate.against_zero = search.rise(best, j, search.low(j));
  const bool is_zero = estimate.against_zero < kAsGoodAsZero * options.tolerance;
  estimate.sigma = is_zero ? 0.0 : std::exp(best.log_sigma[j]);
  return estimate;
}

// Moves the poses to the optimum of the best σ, until that changes nothing.
class Relinearisation {
 public:
  Relinearisation(const MeasurementLog& log, std::span<const VarianceComponent> components,
                  const VarianceOptions& options, const std::vector<bool>& used)
      : log_(log), components_(components), options_(options), used_(used) {}

  /// From the best σ of the same log with other registrations; none: from a grid.
  VarianceEstimate run(std::span<const Pose> trajectory, Eigen::VectorXd& log_sigma) {
    VarianceEstimate estimate;
    estimate.outcome = VarianceEstimate::Outcome::iteration_limit;
    estimate.trajectory.assign(trajectory.begin(), trajectory.end());
    DevianceSearch::Optimum last;
    for (int i = 0; i < std::max(1, options_.max_linearisations); ++i) {
      RestrictedLikelihood likelihood(log_, estimate.trajectory, components_, used_);
      if (!likelihood.rows().is_finite()) return failed(std::move(estimate));
      DevianceSearch search(likelihood, components_, options_.tolerance);
      if (search.has_nothing()) return nothing_told(likelihood, std::move(estimate));
      if (log_sigma.size() == 0) log_sigma = search.best_of_grid(search.told());
      const DevianceSearch::Optimum best =
          i == 0 ? search.minimise_beyond_zero(log_sigma) : search.minimise(log_sigma);
      if (!best.is_finite()) return failed(std::move(estimate));
      log_sigma = best.log_sigma;
      const bool is_settled =
          i > 0 && std::abs(best.fit.deviance - last.fit.deviance) < 1000.0 * options_.tolerance;
      const bool is_last = is_settled || i + 1 >= options_.max_linearisations;
      if (is_settled) estimate.outcome = VarianceEstimate::Outcome::converged;
      if (is_last) conclude(likelihood, best, estimate);
      if (is_last) break;
      estimate.trajectory = likelihood.rows().moved(estimate.trajectory, best.fit.y);
      last = best;
    }
    return estimate;
  }

 private:
  static VarianceEstimate failed(VarianceEstimate estimate) {
    estimate.outcome = VarianceEstimate::Outcome::numerical_failure;
    return estimate;
  }

  static VarianceEstimate nothing_told(const RestrictedLikelihood& likelihood,
                                       VarianceEstimate estimate) {
    estimate.outcome = VarianceEstimate::Outcome::nothing_told;
    estimate.registrations = likelihood.rows().told().size();
    estimate.components.resize(static_cast<std::size_t>(likelihood.components()));
    return estimate;
  }

  // Without intervals where registrations are to be left out.
  void conclude(RestrictedLikelihood& likelihood, const DevianceSearch::Optimum& best,
                VarianceEstimate& estimate) const {
    estimate.log_likelihood = -0.5 * best.fit.deviance;
    estimate.chi2 = best.fit.chi2;
    estimate.degrees_of_freedom = likelihood.degrees_of_freedom();
    estimate.registrations = likelihood.rows().told().size();
    estimate.left_out_chi2 = likelihood.left_out_chi2(best.log_sigma);
    if (!contradicted(log_, estimate.left_out_chi2, options_.contradiction).empty()) return;
    estimate.components = estimates(estimate.trajectory, best);
  }

  // Side by side: each from the optimum, with a likelihood of its own.
  std::vector<SigmaEstimate> estimates(std::span<const Pose> trajectory,
                                       const DevianceSearch::Optimum& best) const {
    std::vector<SigmaEstimate> estimates(components_.size());
    std::vector<std::exception_ptr> errors(components_.size());
    Workers workers(std::max(1, std::min(options_.threads, static_cast<int>(components_.size()))));
    for_ranges(&workers, components_.size(), 1, [&](std::size_t j, std::size_t /*end*/) {
      try {
        RestrictedLikelihood likelihood(log_, trajectory, components_, used_);
        DevianceSearch search(likelihood, components_, options_.tolerance);
        estimates[j] =
            estimate_of(search, likelihood, best, static_cast<Eigen::Index>(j), options_);
      } catch (...) {
        errors[j] = std::current_exception();
      }
    });
    for (const std::exception_ptr& error : errors) {
      if (error) std::rethrow_exception(error);
    }
    return estimates;
  }

  const MeasurementLog& log_;
  std::span<const VarianceComponent> components_;
  const VarianceOptions& options_;
  const std::vector<bool>& used_;
};

}  // namespace

VarianceEstimate estimate_variance(const MeasurementLog& log, std::span<const Pose> trajectory,
                                   std::span<const VarianceComponent> components,
                                   const VarianceOptions& options) {
  check(log, trajectory, components, options);
  std::vector<bool> used = options.used;
  if (used.empty()) used.assign(log.registration_count(), true);
  VarianceEstimate estimate;
  estimate.trajectory.assign(trajectory.begin(), trajectory.end());
  Eigen::VectorXd log_sigma;
  for (bool is_done = false; !is_done;) {
    estimate = Relinearisation(log, components, options, used).run(estimate.trajectory, log_sigma);
    const std::vector<std::size_t> out =
        contradicted(log, estimate.left_out_chi2, options.contradiction);
    for (const std::size_t registration : out) used[registration] = false;
    is_done = out.empty();
  }
  estimate.used = used;
  return estimate;
}

double restricted_log_likelihood(const MeasurementLog& log, std::span<const Pose> trajectory,
                                 std::span<const VarianceComponent> components,
                                 std::span<const double> sigmas, const VarianceOptions& options,
                                 Eigen::VectorXd* likelihood_log_sigma) {
  check(log, trajectory, components, options);
  check_size(sigmas.size(), components.size(), "standard deviations");
  RestrictedLikelihood likelihood(log, trajectory, components, options.used);
  const Eigen::Map<const Eigen::VectorXd> sigma(sigmas.data(),
                                                static_cast<Eigen::Index>(sigmas.size()));
  const Eigen::VectorXd log_sigma = sigma.array().log();
  if (likelihood_log_sigma == nullptr) return -0.5 * likelihood.deviance(log_sigma);
  const RestrictedFit fit = likelihood.fit(log_sigma);
  *likelihood_log_sigma = -0.5 * fit.slope;
  return -0.5 * fit.deviance;
}

}  // namespace fathom

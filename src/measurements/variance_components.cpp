#include "fathom/measurements/variance_components.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "deviance_search.hpp"
#include "fathom/core/chi_squared.hpp"
#include "fathom/core/input_error.hpp"
#include "restricted_likelihood.hpp"

namespace fathom {
namespace {

bool governs(const VarianceComponent& component, std::size_t k) {
  return component.governed.empty() || component.governed[k];
}

void check_size(std::size_t found, std::size_t expected, const std::string& what) {
  if (found == expected) return;
  throw InputError(std::to_string(found) + " " + what + ", expected " + std::to_string(expected));
}

void check(const MeasurementLog& log, std::span<const VarianceComponent> components) {
  for (std::size_t j = 0; j < components.size(); ++j) {
    const VarianceComponent& component = components[j];
    if (!component.governed.empty()) {
      check_size(component.governed.size(), log.size(), "marks of governed pictures");
    }
    if (!component.least.empty()) {
      check_size(component.least.size(), log.size(), "least standard deviations");
    }
    for (std::size_t i = 0; i < j; ++i) {
      for (std::size_t k = 0; k < log.size(); ++k) {
        if (components[i].part == component.part && governs(components[i], k) &&
            governs(component, k)) {
          throw InputError("two components govern picture " + std::to_string(k));
        }
      }
    }
  }
}

void check(const MeasurementLog& log, std::span<const Pose> trajectory,
           std::span<const VarianceComponent> components, const VarianceOptions& options) {
  check(log, components);
  check_size(trajectory.size(), log.size(), "poses");
  if (!options.used.empty()) {
    check_size(options.used.size(), log.registration_count(), "marks of used registrations");
  }
}

// An optimum as good as 0, by so many tolerances of the search, is 0.
constexpr double kAsGoodAsZero = 100.0;

SigmaEstimate estimate_of(DevianceSearch& search, const RestrictedLikelihood& likelihood,
                          const DevianceSearch::Optimum& best, Eigen::Index j,
                          const VarianceOptions& options) {
  SigmaEstimate estimate;
  estimate.pictures = likelihood.pictures(j);
  if (search.is_held(j)) return estimate;
  const double level = chi_squared_quantile(options.probability, 1.0);
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
                  const VarianceOptions& options)
      : log_(log), components_(components), options_(options) {}

  VarianceEstimate run(std::span<const Pose> trajectory) {
    VarianceEstimate estimate;
    estimate.outcome = VarianceEstimate::Outcome::iteration_limit;
    estimate.trajectory.assign(trajectory.begin(), trajectory.end());
    DevianceSearch::Optimum last;
    for (int i = 0; i < std::max(1, options_.max_linearisations); ++i) {
      RestrictedLikelihood likelihood(log_, estimate.trajectory, components_, options_.used);
      DevianceSearch search(likelihood, components_, options_.tolerance);
      if (search.has_nothing()) return nothing_told(likelihood, std::move(estimate));
      const DevianceSearch::Optimum best =
          i == 0 ? search.minimise_from_grid(search.told()) : search.minimise(last.log_sigma);
      if (!best.is_finite()) return failed(std::move(estimate));
      const bool is_settled =
          i > 0 && std::abs(best.fit.deviance - last.fit.deviance) < 1000.0 * options_.tolerance;
      const bool is_last = is_settled || i + 1 >= options_.max_linearisations;
      if (is_settled) estimate.outcome = VarianceEstimate::Outcome::converged;
      if (is_last) conclude(likelihood, search, best, estimate);
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
    estimate.registrations = likelihood.rows().told();
    estimate.components.resize(static_cast<std::size_t>(likelihood.components()));
    return estimate;
  }

  void conclude(const RestrictedLikelihood& likelihood, DevianceSearch& search,
                const DevianceSearch::Optimum& best, VarianceEstimate& estimate) const {
    estimate.log_likelihood = -0.5 * best.fit.deviance;
    estimate.chi2 = best.fit.chi2;
    estimate.degrees_of_freedom = likelihood.degrees_of_freedom();
    estimate.registrations = likelihood.rows().told();
    for (Eigen::Index j = 0; j < likelihood.components(); ++j) {
      estimate.components.push_back(estimate_of(search, likelihood, best, j, options_));
    }
  }

  const MeasurementLog& log_;
  std::span<const VarianceComponent> components_;
  const VarianceOptions& options_;
};

void set_sigmas(PictureErrors& errors, std::size_t k, std::span<const VarianceComponent> components,
                std::span<const double> sigmas) {
  for (std::size_t j = 0; j < components.size(); ++j) {
    if (!governs(components[j], k)) continue;
    const double least = components[j].least.empty() ? 0.0 : components[j].least[k];
    const double sigma = std::max(least, sigmas[j]);
    if (components[j].part == VarianceComponent::Part::altitude) {
      errors.sigma[0] = sigma;
    } else {
      errors.sigma.tail<2>().setConstant(sigma);
    }
  }
}

RelativePose with_sigmas(RelativePose z, std::span<const VarianceComponent> components,
                         std::span<const double> sigmas) {
  if (!z.shared) return z;
  SharedErrors shared = *z.shared;
  set_sigmas(shared.from, z.from, components, sigmas);
  set_sigmas(shared.to, z.to, components, sigmas);
  if (shared == *z.shared) return z;
  z.information = RelativePose::from_covariance(z.from, z.to, z.motion, shared.total()).information;
  z.shared = std::make_shared<const SharedErrors>(shared);
  return z;
}

}  // namespace

VarianceEstimate estimate_variance(const MeasurementLog& log, std::span<const Pose> trajectory,
                                   std::span<const VarianceComponent> components,
                                   const VarianceOptions& options) {
  check(log, trajectory, components, options);
  return Relinearisation(log, components, options).run(trajectory);
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

MeasurementLog with_sigmas(const MeasurementLog& log, std::span<const VarianceComponent> components,
                           std::span<const double> sigmas) {
  check(log, components);
  check_size(sigmas.size(), components.size(), "standard deviations");
  MeasurementLog changed(log.start());
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0) changed.add_keyframe(arrival.step);
    for (const RelativePose& z : arrival.registrations) {
      changed.add_registration(with_sigmas(z, components, sigmas));
    }
    for (const AbsolutePose& z : arrival.absolute) changed.add_absolute(z);
  }
  changed.ids = log.ids;
  changed.guess = log.guess;
  return changed;
}

}  // namespace fathom

#include "fathom/harness/map_fit.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "fathom/core/chi_squared.hpp"
#include "fathom/core/median.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

namespace {

// Of a χ² with three degrees of freedom.
constexpr double kMedianNis = 2.366;

NisSpread spread_of(std::vector<double> nis) {
  if (nis.empty()) return {};
  const double sum = std::accumulate(nis.begin(), nis.end(), 0.0);
  const double largest = *std::ranges::max_element(nis);
  return {nis.size(), sum / static_cast<double>(nis.size()), upper_median(std::move(nis)), largest};
}

}  // namespace

bool MapFit::estimate_fits() const {
  constexpr double kProbability = 0.99;
  const double scale = std::max(1.0, per_degree_of_freedom());
  // Truth itself has an F of one a row on average, however errors are shared; gains that allow for
  // them lead no further off than this.
  const double most = considers_shared_errors ? 3.0 * degrees_of_freedom
                                              : chi_squared_quantile(kProbability, unknowns);
  return chi2 - chi2_optimum <= scale * most;
}

double MapFit::largest_nis_by_chance() const {
  constexpr double kChance = 1e-6;
  const auto count = static_cast<double>(std::max<std::size_t>(1, registrations.count));
  return std::max(1.0, per_degree_of_freedom()) * chi_squared_quantile(1.0 - kChance / count, 3.0);
}

// By the loops, not by the steps: one false loop of a chain bends all its steps alike, and slips of
// dead reckoning are few steps, as those are that a false loop bends.
StepBlame MapFit::step_blame() const {
  constexpr std::size_t kFewest = 8;
  constexpr double kFewMiss = 0.2;
  constexpr double kAlike = 0.5;
  if (registrations.count < kFewest) return StepBlame::unclear;
  const double loops = registrations.median_to_mean();
  if (loops < kFewMiss && registrations.median < 2.0 * kMedianNis) return StepBlame::loops;
  if (loops < kAlike) return StepBlame::unclear;
  const bool do_most_steps_fit = steps.median < 2.0 * kMedianNis && steps.median_to_mean() < 0.1;
  return do_most_steps_fit ? StepBlame::slips : StepBlame::covariance;
}

std::optional<MapFit> map_fit(const MeasurementLog& log, std::span<const Pose> estimate,
                              const BatchOptimum& optimum, const Run* run) {
  MapFit fit;
  if (run != nullptr) {
    fit.chi2_used = run->chi2_used;
    fit.absolute_left_out = absolute_chi2(log, estimate) - run->absolute_chi2_used;
  }
  fit.degrees_of_freedom = degrees_of_freedom(log);
  if (log.registration_count() == 0 || !(fit.degrees_of_freedom > 0.0)) return std::nullopt;
  fit.chi2 = chi2(log, estimate, optimum.errors);
  fit.chi2_optimum = optimum.chi2;
  fit.chi2_alone = chi2_alone(log, optimum.poses, optimum.errors);
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  double repeats = 0.0;
  std::vector<double> of_steps;
  std::vector<double> of_registrations;
  for (std::size_t k = 1; k < log.size(); ++k) {
    const RelativePose& step = log.arrival(k).step;
    const Eigen::Vector3d e =
        residual(step.motion, optimum.poses[step.from], optimum.poses[step.to]);
    if (!step.is_hole) of_steps.push_back(e.dot(step.information * e));
    for (const RelativePose& told : log.arrival(k).registrations) {
      const RelativePose z = told.alone();
      repeats += told.repeats;
      const Eigen::Vector3d off = residual(z.motion, optimum.poses[z.from], optimum.poses[z.to]);
      of_registrations.push_back(off.dot(z.information * off));
      squares += off.cwiseAbs2();
      variances += z.covariance().diagonal();
    }
  }
  fit.steps_at_optimum = std::accumulate(of_steps.begin(), of_steps.end(), 0.0);
  fit.steps = spread_of(std::move(of_steps));
  fit.registrations = spread_of(std::move(of_registrations));
  const auto count = static_cast<double>(log.registration_count());
  fit.registration_rms_m = std::sqrt((squares.x() + squares.y()) / count);
  fit.registration_rms_rad = std::sqrt(squares.z() / count);
  fit.registration_sigma_m = std::sqrt((variances.x() + variances.y()) / count);
  fit.registration_sigma_rad = std::sqrt(variances.z() / count);
  fit.mean_repeats = repeats / count;
  fit.absolute_at_optimum = absolute_chi2(log, optimum.poses);
  fit.unknowns = determined_unknowns(log);
  return fit;
}

namespace {

std::string nis_text(const NisSpread& nis) {
  return "(NIS: median " + short_number(nis.median, 2) + ", mean " + short_number(nis.mean, 2) +
         ")";
}

// What follows "… of F is of dead reckoning, ".
std::string step_remark(const MapFit& fit) {
  const std::string loops = nis_text(fit.registrations);
  switch (fit.step_blame()) {
    case StepBlame::loops:
      return "most loops fit and few do not " + loops +
             ", so these are wrong and bend it (a robust loss, a gate), or it slips there";
    case StepBlame::covariance:
      return "and loops miss alike " + loops +
             ", so its covariance is too small for what they say (dataset.added_noise), unless "
             "most of them are wrong";
    case StepBlame::slips:
      return "of few steps " + nis_text(fit.steps) + ", and loops fit each other " + loops +
             ", so it slips there, or its covariance is too small (dataset.added_noise)";
    case StepBlame::unclear:
      break;
  }
  return "so either its covariance is too small (dataset.added_noise), or some loops are wrong and "
         "bend it (a robust loss, a gate; compare F with estimator.loss)";
}

std::string misfit_remark(const MapFit& fit, bool set_up_is_wrong) {
  const double of_steps = fit.steps_at_optimum / fit.alone_at_optimum();
  const double of_absolute = fit.absolute_at_optimum / fit.alone_at_optimum();
  const std::string text = "the measurements do not fit each other: F per degree of freedom is " +
                           short_number(fit.per_degree_of_freedom()) +
                           " at its best, and 1 is expected; ";
  if (set_up_is_wrong) return text + "the set-up is wrong (above), which comes before covariances";
  if (of_absolute > 0.5) {
    return text + short_number(100.0 * of_absolute, 2) +
           " % of F is of absolute measurements, so their covariances are too small or some are "
           "wrong (a robust loss, a gate)";
  }
  return text + short_number(100.0 * of_steps, 2) + " % of F is of dead reckoning, " +
         (of_steps > 0.5
              ? step_remark(fit)
              : "so covariances of registrations are too small (front_end.covariance) or some "
                "loops are wrong (a robust loss, a gate): registrations are off by " +
                    short_number(fit.registration_rms_m, 2) + " m and " +
                    short_number(fit.registration_rms_rad, 2) +
                    " rad there (rms), where their covariances say " +
                    short_number(fit.registration_sigma_m, 2) + " m and " +
                    short_number(fit.registration_sigma_rad, 2) + " rad");
}

std::string largest_nis_text(const MapFit& fit) {
  return "NIS " + short_number(fit.registrations.largest, 3) + ", and chance leaves " +
         short_number(fit.largest_nis_by_chance(), 3) + " at most";
}

std::string contradiction_remark(const MapFit& fit) {
  return "a loop contradicts the other measurements: it has " + largest_nis_text(fit) +
         ", where F is at its best; some loops are wrong (a robust loss, a gate), or covariances "
         "are too small";
}

std::string left_out_remark(const MapFit& fit, const std::string& estimator) {
  const bool is_absolute = fit.absolute_left_out > 0.5 * (fit.chi2 - *fit.chi2_used);
  const std::string what = is_absolute ? "headings and fixes" : "loops";
  return estimator + " rejected or weighed down " + what + " of which most of F is: F is " +
         short_number(fit.chi2, 6) + " with all " + what + ", " + short_number(*fit.chi2_used, 6) +
         " with what it used. Either these are false, or it lost right ones; a batch solve of all "
         "cannot tell, as it does not fit them either (" +
         (fit.is_far_above_chance()
              ? "F per degree of freedom " + short_number(fit.per_degree_of_freedom())
              : "a loop has " + largest_nis_text(fit)) +
         "). " +
         (is_absolute ? "See whether headings and fixes are in the same axes, and compare back "
                        "ends with and without them"
                      : "Compare back ends with a robust loss");
}

}  // namespace

bool takes_shared_errors_as(const std::string& word, const MeasurementLog& log,
                            const EstimatorConfiguration& estimator,
                            const EstimatorRegistry& registry) {
  if (!log.tells_shared_errors()) return false;
  const auto in_force = estimator_options(estimator, registry.find(estimator.type));
  return std::ranges::any_of(in_force, [&](const auto& option) {
    return option.first == "shared_errors" && option.second == word;
  });
}

std::vector<std::string> map_remarks(const MapFit& fit, const std::string& estimator,
                                     const std::string& solver, bool set_up_is_wrong) {
  std::vector<std::string> remarks;
  if (!std::isfinite(fit.chi2)) {
    remarks.push_back("there is no map of " + estimator + ": its poses are not finite; " + solver +
                      ", which solves the same log at once, has F " +
                      short_number(fit.chi2_optimum, 6));
  } else if (fit.leaves_out_most()) {
    remarks.push_back(left_out_remark(fit, estimator));
    return remarks;
  } else if (!fit.estimate_fits()) {
    remarks.push_back("the map of " + estimator + " does not fit its own measurements: F is " +
                      short_number(fit.chi2, 6) + ", and " + short_number(fit.chi2_optimum, 6) +
                      " where a batch solve of the same log ends; " + solver + " would do");
  }
  if (fit.is_far_above_chance()) {
    remarks.push_back(misfit_remark(fit, set_up_is_wrong));
  } else if (fit.is_one_contradicted() && !set_up_is_wrong) {
    remarks.push_back(contradiction_remark(fit));
  }
  return remarks;
}

std::optional<std::string> sharing_remark(const MapFit& fit, const std::string& estimator) {
  constexpr double kTooLittle = 0.6;
  // Where keypoints count once, errors that cancel around loops are allowed for.
  constexpr double kAllowedFor = 1.5;
  if (fit.per_degree_of_freedom() > kTooLittle || fit.mean_repeats > kAllowedFor) {
    return std::nullopt;
  }
  return "F per degree of freedom is " + short_number(fit.per_degree_of_freedom()) +
         " at its best, and 1 is expected: registrations of a picture share errors, which " +
         estimator +
         " takes as independent, or covariances are too large; the former makes its own too small "
         "where a keyframe has many loops (estimator.shared_errors: states estimates them)";
}

}  // namespace fathom

#include "fathom/harness/map_fit.hpp"

#include <algorithm>
#include <cmath>

#include "fathom/core/chi_squared.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

bool MapFit::estimate_fits() const {
  constexpr double kProbability = 0.99;
  const double scale = std::max(1.0, per_degree_of_freedom());
  return chi2 - chi2_optimum <= scale * chi_squared_quantile(kProbability, unknowns);
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
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  Eigen::Vector3d variances = Eigen::Vector3d::Zero();
  for (std::size_t k = 1; k < log.size(); ++k) {
    const RelativePose& step = log.arrival(k).step;
    const Eigen::Vector3d e =
        residual(step.motion, optimum.poses[step.from], optimum.poses[step.to]);
    if (!step.is_hole) fit.steps_at_optimum += e.dot(step.information * e);
    for (const RelativePose& z : log.arrival(k).registrations) {
      squares += residual(z.motion, optimum.poses[z.from], optimum.poses[z.to]).cwiseAbs2();
      variances += z.covariance().diagonal();
    }
  }
  const auto count = static_cast<double>(log.registration_count());
  fit.registration_rms_m = std::sqrt((squares.x() + squares.y()) / count);
  fit.registration_rms_rad = std::sqrt(squares.z() / count);
  fit.registration_sigma_m = std::sqrt((variances.x() + variances.y()) / count);
  fit.registration_sigma_rad = std::sqrt(variances.z() / count);
  fit.absolute_at_optimum = absolute_chi2(log, optimum.poses);
  fit.unknowns = determined_unknowns(log);
  return fit;
}

namespace {

std::string misfit_remark(const MapFit& fit, bool set_up_is_wrong) {
  const double of_steps = fit.steps_at_optimum / fit.chi2_optimum;
  const double of_absolute = fit.absolute_at_optimum / fit.chi2_optimum;
  const std::string text = "the measurements do not fit each other: F per degree of freedom is " +
                           short_number(fit.per_degree_of_freedom()) +
                           " at its best, and 1 is expected; ";
  if (set_up_is_wrong) return text + "the set-up is wrong (above), which comes before covariances";
  if (of_absolute > 0.5) {
    return text + short_number(100.0 * of_absolute, 2) +
           " % of F is of absolute measurements, so their covariances are too small or some are "
           "wrong (a robust loss, a gate)";
  }
  return text + short_number(100.0 * of_steps, 2) + " % of F is of dead reckoning, so " +
         (of_steps > 0.5
              ? "its covariance is too small for what loops say (dataset.added_noise)"
              : "covariances of registrations are too small (front_end.covariance) or some loops "
                "are wrong (a robust loss, a gate): registrations are off by " +
                    short_number(fit.registration_rms_m, 2) + " m and " +
                    short_number(fit.registration_rms_rad, 2) +
                    " rad there (rms), where their covariances say " +
                    short_number(fit.registration_sigma_m, 2) + " m and " +
                    short_number(fit.registration_sigma_rad, 2) + " rad");
}

std::string left_out_remark(const MapFit& fit, const std::string& estimator) {
  const bool is_absolute = fit.absolute_left_out > 0.5 * (fit.chi2 - *fit.chi2_used);
  const std::string what = is_absolute ? "headings and fixes" : "loops";
  return estimator + " rejected or weighed down " + what + " of which most of F is: F is " +
         short_number(fit.chi2, 6) + " with all " + what + ", " + short_number(*fit.chi2_used, 6) +
         " with what it used. Either these are false, or it lost right ones; a batch solve of all "
         "cannot tell, as it does not fit them either (F per degree of freedom " +
         short_number(fit.per_degree_of_freedom()) + "). " +
         (is_absolute ? "See whether headings and fixes are in the same axes, and compare back "
                        "ends with and without them"
                      : "Compare back ends with a robust loss");
}

}  // namespace

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
  if (fit.measurements_disagree()) {
    remarks.push_back(misfit_remark(fit, set_up_is_wrong));
  }
  return remarks;
}

std::optional<std::string> sharing_remark(const MapFit& fit, const std::string& estimator) {
  constexpr double kTooLittle = 0.6;
  if (fit.per_degree_of_freedom() > kTooLittle) return std::nullopt;
  return "F per degree of freedom is " + short_number(fit.per_degree_of_freedom()) +
         " at its best, and 1 is expected: registrations of a picture share errors, which " +
         estimator +
         " takes as independent, or covariances are too large; the former makes its own too small "
         "where a keyframe has many loops (estimator.shared_errors: states estimates them)";
}

}  // namespace fathom

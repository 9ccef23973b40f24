// Whether the covariances of the registrations are what their errors are: of the log against ground
// truth, whatever an estimator makes of it; and what F says without any truth.

#include <Eigen/Eigenvalues>

#include "fathom/geometry/covariance.hpp"
#include "groups.hpp"

namespace fathom {
namespace {

using Value = std::optional<double>;

template <class Visit>
void for_registrations(const MeasurementLog& log, const Visit& visit) {
  for (std::size_t k = 1; k < log.size(); ++k) {
    for (const RelativePose& z : log.arrival(k).registrations) visit(z);
  }
}

Value mean_nis_truth(const JudgedRun& run) {
  const RunFacts& facts = run.facts;
  if (facts.run == nullptr || !facts.ground_truth || facts.log.registration_count() == 0) return {};
  const std::span<const Pose> truth = *facts.ground_truth;
  double sum = 0.0;
  for_registrations(facts.log, [&](const RelativePose& z) {
    sum += chi2(z.alone(), truth[z.from], truth[z.to]);
  });
  return sum / static_cast<double>(facts.log.registration_count());
}

Value chi2_per_dof(const JudgedRun& run) {
  const RunFacts& facts = run.facts;
  if (facts.run == nullptr) return {};
  const double degrees = degrees_of_freedom(facts.log);
  if (!(degrees > 0.0)) return {};
  return chi2_alone(facts.log, facts.estimate, facts.run->errors) / degrees;
}

// Of the registrations that share a picture: Σ u and Σ uᵀu of their whitened errors u, and the same
// of what of them an estimator takes out as shared, Cov(uᵢ, uⱼ) = Bᵢ Bⱼᵀ.
struct SharedPicture {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double squares = 0.0;
  double count = 0.0;
  Eigen::Matrix3d told = Eigen::Matrix3d::Zero();
  double told_squares = 0.0;

  // Ω^½ e, with the symmetric root: u is in the axes of `to` as e is, and `to` is the picture.
  void add(const RelativePose& z, std::span<const Pose> truth, bool is_estimated) {
    const Eigen::Matrix3d root =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(z.information).operatorSqrt();
    const Eigen::Vector3d u = root * residual(z.motion, truth[z.from], truth[z.to]);
    sum += u;
    squares += u.squaredNorm();
    count += 1.0;
    if (!is_estimated || !z.shared) return;
    const Eigen::Matrix3d B =
        root * planar_rotation(z.motion.theta).transpose() * z.shared->to.scaled();
    told += B;
    told_squares += B.squaredNorm();
  }
};

// Each registration counts at both of its pictures, as the error of where the picture is seen from
// the other one. A picture's own error is the same in all of them.
Value picture_error_correlation(const JudgedRun& run) {
  const RunFacts& facts = run.facts;
  if (facts.run == nullptr || !facts.ground_truth) return {};
  const std::span<const Pose> truth = *facts.ground_truth;
  const bool is_estimated = facts.run->errors == RegistrationErrors::shared;
  std::vector<SharedPicture> pictures(facts.log.size());
  for_registrations(facts.log, [&](const RelativePose& z) {
    const RelativePose alone = z.alone();
    pictures[z.to].add(alone, truth, is_estimated);
    pictures[z.from].add(alone.reversed(), truth, is_estimated);
  });
  double products = 0.0;  // Σ uᵢᵀuⱼ over the pairs i < j of a picture
  double squares = 0.0;   // Σ (uᵢᵀuᵢ + uⱼᵀuⱼ) / 2 over the same
  for (const SharedPicture& of : pictures) {
    products += 0.5 * (of.sum.squaredNorm() - of.squares);
    products -= 0.5 * (of.told.squaredNorm() - of.told_squares);
    squares += 0.5 * (of.count - 1.0) * of.squares;
  }
  if (!(squares > 0.0)) return {};
  return products / squares;
}

}  // namespace

std::vector<Metric> honesty_metrics() {
  return {
      {"mean_nis_truth", "mean NIS against truth", "", Better::neither,
       "mean of the log's registrations at ground truth; 3 expected, above: their covariances are "
       "too small",
       mean_nis_truth},
      {"picture_error_correlation", "correlation of a picture's errors", "", Better::neither,
       "of the errors of two registrations that share a picture, against ground truth, less what "
       "of it the estimator estimates; 0 expected",
       picture_error_correlation},
      {"chi2_per_dof", "F per degree of freedom", "", Better::neither,
       "F over its degrees of freedom, the rows of its residual less the rank of their Jacobian, "
       "each registration with the covariance that it has alone; 1 expected at the optimum, below: "
       "covariances are too large, or errors are shared and cancel",
       chi2_per_dof},
  };
}

}  // namespace fathom

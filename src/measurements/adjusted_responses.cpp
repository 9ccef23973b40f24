#include "fathom/measurements/adjusted_responses.hpp"

#include <cmath>
#include <memory>

#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// Of an own error: ten of its standard deviations. What contradicts the others tells no error.
constexpr double kMostChi2 = 100.0;

void adjust(PictureErrors& errors, const Eigen::Vector3d& own_error, double altitude_m) {
  if (errors.sigma[0] > 0.0) errors.G.col(0).head<2>() -= own_error.head<2>() / (2.0 * altitude_m);
}

RelativePose adjusted(const RelativePose& z, Eigen::Vector3d own_error,
                      std::span<const double> altitudes_m) {
  SharedErrors shared = *z.shared;
  const double chi2 = own_error.dot(symmetric_inverse(shared.own) * own_error);
  if (!std::isfinite(chi2)) return z;
  if (chi2 > kMostChi2) own_error *= std::sqrt(kMostChi2 / chi2);
  adjust(shared.from, own_error, altitudes_m[z.from]);
  adjust(shared.to, own_error, altitudes_m[z.to]);
  if (shared == *z.shared) return z;
  RelativePose told = RelativePose::from_covariance(z.from, z.to, z.motion, shared.total());
  told.inliers = z.inliers;
  told.repeats = z.repeats;
  told.shared = std::make_shared<const SharedErrors>(shared);
  return told;
}

}  // namespace

MeasurementLog with_adjusted_responses(const MeasurementLog& log, std::span<const Pose> optimum,
                                       std::span<const double> altitudes_m) {
  const std::vector<Eigen::Vector3d> errors = own_errors(log, optimum);
  auto error = errors.begin();
  return with_registrations(log, [&](const RelativePose& z, std::size_t) {
    return z.shared ? adjusted(z, *error++, altitudes_m) : z;
  });
}

}  // namespace fathom

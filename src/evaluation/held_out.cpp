#include "fathom/evaluation/held_out.hpp"

#include <cmath>

#include "checks.hpp"
#include "fathom/evaluation/summary.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

double rms_of(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value * value;
  return std::sqrt(sum / static_cast<double>(values.size()));
}

// νᵀ (P + R)⁻¹ ν; nothing where that is no covariance.
std::optional<double> innovation_squared(const RelativePose& z, const Pose& A, const Pose& B,
                                         const Eigen::Matrix3d& P) {
  const Eigen::Matrix3d S = P + z.covariance();
  if (!is_positive_definite(S)) return std::nullopt;
  const Pose h = between(A, B);
  const Eigen::Vector3d innovation(z.motion.x - h.x, z.motion.y - h.y,
                                   wrap_angle(z.motion.theta - h.theta));
  return innovation.dot(symmetric_inverse(S) * innovation);
}

std::optional<double> mean_nis_of(const HeldOutLoops& held_out) {
  if (held_out.covariances.empty()) return std::nullopt;
  require_same_length(held_out.tested.size(), held_out.covariances.size(),
                      "covariances of held-out loops");
  double sum = 0.0;
  for (std::size_t i = 0; i < held_out.tested.size(); ++i) {
    const RelativePose& z = held_out.loops.at(held_out.tested[i]);
    const auto nis = innovation_squared(z.alone(), held_out.estimate[z.from],
                                        held_out.estimate[z.to], held_out.covariances[i]);
    if (!nis) return std::nullopt;
    sum += *nis;
  }
  const double mean = sum / static_cast<double>(held_out.tested.size());
  return std::isfinite(mean) ? std::optional(mean) : std::nullopt;
}

}  // namespace

std::optional<HeldOutErrors> held_out_errors(const HeldOutLoops& held_out) {
  if (held_out.loops.empty() || !all_finite(held_out.estimate)) return std::nullopt;
  std::vector<double> position_m;
  std::vector<double> heading_rad;
  for (const RelativePose& z : held_out.loops) {
    const Eigen::Vector3d e =
        residual(z.motion, held_out.estimate.at(z.from), held_out.estimate.at(z.to));
    position_m.push_back(e.head<2>().norm());
    heading_rad.push_back(std::abs(e.z()));
  }
  return HeldOutErrors{quantile(position_m, 0.5), rms_of(position_m), quantile(heading_rad, 0.5),
                       rms_of(heading_rad), mean_nis_of(held_out)};
}

}  // namespace fathom

#include "fathom/estimation/precision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <Eigen/LU>

#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

constexpr double kWide = 1e8;
// Whether a matrix is definite is looked at below.
constexpr double kLeastShareOfAlike = 1e-6;
// Of a matrix that is definite whatever the units of its rows.
constexpr double kRounding = 1e-18;

double size_of(const Pose& pose) {
  return std::max(std::abs(pose.x), std::abs(pose.y));
}

double position_information(const RelativePose& z) {
  return std::max(z.information(0, 0), z.information(1, 1));
}

}  // namespace

bool is_resolved(const RelativePose& z, const Pose& from, const Pose& to) {
  constexpr double kEpsilon = std::numeric_limits<double>::epsilon();
  const double step_m = kEpsilon * std::max({size_of(from), size_of(to), size_of(z.motion)});
  const double step_rad = kEpsilon * std::numbers::pi;
  const double rounding =
      position_information(z) * step_m * step_m + z.information(2, 2) * step_rad * step_rad;
  return rounding <= kMostRoundingChi2;
}

bool are_resolved(const TrajectoryView& estimate, std::span<const RelativePose> registrations) {
  return std::all_of(registrations.begin(), registrations.end(), [&](const RelativePose& z) {
    return is_resolved(z, estimate.pose(z.from), estimate.pose(z.to));
  });
}

// The determinant, and for all axes alike what it would be with this diagonal.
double own_spread(const Eigen::Matrix3d& information) {
  const double mean = 0.5 * (information(0, 0) + information(1, 1));
  const double alike = mean * mean * information(2, 2);
  const double determinant = information.determinant();
  if (determinant > alike * kLeastShareOfAlike) return alike / determinant;
  return is_positive_definite(information) ? alike / std::max(determinant, kRounding * alike) : 1.0;
}

// What is not measured is not small.
void InformationSpread::Bounds::add(double value) {
  if (value == 0.0) return;
  least = std::min(least, value);
  most = std::max(most, value);
}

bool InformationSpread::Bounds::is_wide() const {
  return most > kWide * least;
}

void InformationSpread::add(const RelativePose& measurement) {
  if (measurement.is_hole) return;
  position_.add(position_information(measurement));
  heading_.add(measurement.information(2, 2));
  own_ = std::max(own_, own_spread(measurement.information));
}

bool InformationSpread::is_wide() const {
  return position_.is_wide() || heading_.is_wide() || own_ > kWide;
}

}  // namespace fathom

#include "odometry_steps.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"
#include "odometry_restarts.hpp"

namespace fathom {
namespace {

// The part of x, y and the rotation about z.
Eigen::Matrix3d planar(const Matrix6& covariance) {
  constexpr std::array<int, 3> kPlanar{0, 1, 5};
  Eigen::Matrix3d part;
  for (int i = 0; i < 3; ++i) {
    for (int j = 0; j < 3; ++j) {
      part(i, j) = 0.5 * (covariance(kPlanar[i], kPlanar[j]) + covariance(kPlanar[j], kPlanar[i]));
    }
  }
  return part;
}

/// The step from one reading to the next.
struct Step {
  const OdometryReading& before;
  const OdometryReading& after;
  Pose from;
  Pose motion;
  double seconds = 0.0;
};

using StepCovariance = std::function<Eigen::Matrix3d(const Step&)>;

Eigen::Matrix3d growth(const Step& step) {
  const auto& before = step.before.message.pose_covariance;
  const auto& after = step.after.message.pose_covariance;
  if (!before || !after) return Eigen::Matrix3d::Zero();
  Eigen::Matrix3d by_pose;
  Eigen::Matrix3d by_motion;
  compose(step.from, step.motion, &by_pose, &by_motion);
  const Eigen::Matrix3d grown = planar(*after) - transport(by_pose, planar(*before));
  // A rotation of x and y, and 1 for the heading: its transpose is its inverse.
  return transport(by_motion.transpose(), grown);
}

Eigen::Matrix3d of_velocity(const Step& step) {
  const auto& velocity = step.after.message.velocity_covariance;
  if (!velocity) return Eigen::Matrix3d::Zero();
  // Of the body as it arrives, in the axes of the body as it set out.
  return transport(planar_rotation(step.motion.theta),
                   planar(*velocity) * step.seconds * step.seconds);
}

StepCovariance random_walk(double sigma_m, double sigma_rad) {
  const Eigen::Vector3d variances(sigma_m * sigma_m, sigma_m * sigma_m, sigma_rad * sigma_rad);
  return [variances](const Step& step) -> Eigen::Matrix3d {
    return (variances * step.seconds).asDiagonal();
  };
}

// Where odometry starts again: anything up to the length of the jump.
StepCovariance unknown_motion(double sigma_rad) {
  return [sigma_rad](const Step& step) -> Eigen::Matrix3d {
    const double variance_m2 = step.motion.position().squaredNorm();
    return Eigen::Vector3d(variance_m2, variance_m2, sigma_rad * sigma_rad).asDiagonal();
  };
}

// `unknown` at the readings at which the odometry starts again. Nothing where a covariance is none.
std::optional<std::vector<OdometryRow>> rows_by(const std::vector<OdometryReading>& readings,
                                                const std::vector<std::size_t>& restarts,
                                                const StepCovariance& unknown,
                                                const StepCovariance& covariance_of) {
  constexpr double kSecondsPerNs = 1e-9;
  std::vector<OdometryRow> rows;
  for (std::size_t i = 0; i < readings.size(); ++i) {
    OdometryRow row{readings[i].time_ns, planar_pose(readings[i].message), Eigen::Matrix3d::Zero()};
    if (i > 0) {
      const Pose& from = rows.back().pose;
      const auto elapsed_ns = static_cast<double>(row.time_ns - rows.back().time_ns);
      const bool is_restart = std::ranges::binary_search(restarts, i);
      const StepCovariance& covariance = is_restart ? unknown : covariance_of;
      row.step_covariance = covariance({readings[i - 1], readings[i], from, between(from, row.pose),
                                        elapsed_ns * kSecondsPerNs});
      if (!is_positive_definite(row.step_covariance)) return std::nullopt;
    }
    rows.push_back(row);
  }
  return rows;
}

}  // namespace

Pose planar_pose(const PoseMessage& message) {
  constexpr double kMostOff = 0.02;
  const Eigen::Quaterniond& q = message.rotation;
  const double length = q.norm();
  if (!(std::abs(length - 1.0) <= kMostOff) || !message.position.allFinite()) {
    throw InputError("a pose has numbers that are not finite or a quaternion of length " +
                     short_number(length) + "; expected 1");
  }
  const double yaw = std::atan2(2.0 * (q.w() * q.z() + q.x() * q.y()),
                                length * length - 2.0 * (q.y() * q.y() + q.z() * q.z()));
  return {message.position.x(), message.position.y(), wrap_angle(yaw)};
}

OdometryRows odometry_rows(const std::vector<OdometryReading>& readings,
                           const BagImportOptions& options) {
  const double sigma_m = options.odometry_sigma_m.value_or(options.default_odometry_sigma_m);
  const double sigma_rad = options.odometry_sigma_rad.value_or(options.default_odometry_sigma_rad);
  const bool is_given = options.odometry_sigma_m || options.odometry_sigma_rad;
  const std::string walk = "a random walk of " + short_number(sigma_m) + " m and " +
                           short_number(sigma_rad) + " rad in one second";
  const std::vector<std::size_t> restarts =
      odometry_restarts(readings, options.restart_speed_factor);
  const auto rows_of = [&](const StepCovariance& covariance) {
    return rows_by(readings, restarts, unknown_motion(options.restart_sigma_rad), covariance);
  };
  if (!is_given) {
    if (auto rows = rows_of(growth)) {
      return {std::move(*rows), "the growth of the covariance of its pose", restarts};
    }
    if (auto rows = rows_of(of_velocity)) {
      return {std::move(*rows),
              "the covariance of its velocity, independent from message to message", restarts};
    }
  }
  auto rows = rows_of(random_walk(sigma_m, sigma_rad));
  if (!rows) throw InputError("--odometry-sigma-m and --odometry-sigma-rad must be above zero");
  return {std::move(*rows),
          is_given ? walk
                   : "none that could be one in the bag, so " + walk +
                         ": say yours by --odometry-sigma-m and --odometry-sigma-rad",
          restarts};
}

}  // namespace fathom

#include "motion_fit.hpp"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "motion_bends.hpp"
#include "motion_covariance.hpp"
#include "rigid_motion.hpp"

namespace fathom {
namespace {

double squared_residual(const Pose& z, const MatchSet& matches, int index) {
  return (matches.pairs().p(index) - transform(z, matches.pairs().q(index))).squaredNorm();
}

struct Points {
  std::vector<Eigen::Vector2d> p, q;
  std::vector<double> weights;
};

Points points_of(const MatchSet& matches, const std::vector<int>& indices) {
  Points points;
  for (const int index : indices) {
    points.p.push_back(matches.pairs().p(index));
    points.q.push_back(matches.pairs().q(index));
    points.weights.push_back(1.0 / matches.relative_variance(index));
  }
  return points;
}

std::vector<int> within_gate(const Pose& z, const MatchSet& matches, double max_error_m,
                             double gate) {
  std::vector<int> near = matches.one_to_one(matches.pairs().inliers(z, max_error_m));
  if (near.empty()) return near;
  std::vector<double> squares;
  squares.reserve(near.size());
  for (const int index : near) {
    squares.push_back(squared_residual(z, matches, index) / matches.relative_variance(index));
  }
  std::vector<double> sorted = squares;
  const auto middle = sorted.begin() + static_cast<std::ptrdiff_t>(sorted.size() / 2);
  std::nth_element(sorted.begin(), middle, sorted.end());
  // The median of chi squared with two degrees of freedom is 2 ln 2.
  const double variance = *middle / (2.0 * std::log(2.0));
  std::vector<int> kept;
  for (std::size_t k = 0; k < near.size(); ++k) {
    if (squares[k] <= gate * variance) kept.push_back(near[k]);
  }
  return kept;
}

// The registration's own, by what is fitted beside it.
Eigen::Matrix3d own_part(LinearFit linear, const MotionFit& fit, const Viewpoint& from,
                         const Viewpoint& to, const RegistrationOptions& options) {
  const CovarianceOptions& told = options.covariance;
  const CovarianceTuning& tuning = options.tuning.covariance;
  const double left = linear.take_out_altitude_and_tilt(from, to, told);
  const double cell_m = tuning.cluster_px * to.metres_per_pixel;
  Eigen::Matrix3d own = linear.covariance() * linear.clustering(cell_m, tuning.least_clusters) +
                        shared_error(left * fit.rms_m, tuning.shared_error);
  own.diagonal() +=
      Eigen::Vector3d(*told.floor_sigma_m, *told.floor_sigma_m, told.floor_sigma_rad).cwiseAbs2();
  return own;
}

OwnCovariances own_by_told(const LinearFit& linear, const MotionFit& fit, const Viewpoint& from,
                           const Viewpoint& to, const RegistrationOptions& options) {
  OwnCovariances own;
  for (std::size_t told = 0; told < own.by_told.size(); ++told) {
    RegistrationOptions as_told = options;
    std::optional<double>& altitude_m = as_told.covariance.altitude_sigma_m;
    std::optional<double>& tilt_rad = as_told.covariance.tilt_sigma_rad;
    if (altitude_m && (told & 1U) != 0) {
      own.by_told[told] = own.by_told[told - 1];
    } else if (tilt_rad && (told & 2U) != 0) {
      own.by_told[told] = own.by_told[told - 2];
    } else {
      // Of any size: what is told is fitted without a prior.
      if (!altitude_m) altitude_m = (told & 1U) != 0 ? 1.0 : 0.0;
      if (!tilt_rad) tilt_rad = (told & 2U) != 0 ? 1.0 : 0.0;
      own.by_told[told] = own_part(linear, fit, from, to, as_told);
    }
  }
  return own;
}

}  // namespace

MotionFit fit_motion(const Pose& start, const MatchSet& matches,
                     const RegistrationOptions& options) {
  const FitTuning& tuning = options.tuning.fit;
  const double max_error_m = *options.ransac.max_error_m;
  MotionFit fit;
  fit.motion = start;
  fit.inliers = matches.pairs().inliers(start, max_error_m);
  for (int round = 0; round < tuning.rounds; ++round) {
    std::vector<int> inliers = within_gate(fit.motion, matches, max_error_m, tuning.gate);
    const Points points = points_of(matches, inliers);
    const std::optional<Pose> motion = find_motion(points.p, points.q, points.weights);
    if (inliers.size() < 3 || !motion) break;
    const bool settled = inliers == fit.inliers;
    fit.motion = *motion;
    fit.inliers = std::move(inliers);
    if (settled) break;
  }
  double sum = 0.0;
  for (const int index : fit.inliers) sum += squared_residual(fit.motion, matches, index);
  fit.rms_m = std::sqrt(sum / static_cast<double>(fit.inliers.size()));
  return fit;
}

ScaleCheck check_scale(const MotionFit& fit, const MatchSet& matches) {
  const Points points = points_of(matches, fit.inliers);
  if (points.p.size() < 3) return {};
  Eigen::Vector2d p_mean = Eigen::Vector2d::Zero();
  Eigen::Vector2d q_mean = Eigen::Vector2d::Zero();
  double sum = 0.0;
  for (std::size_t j = 0; j < points.p.size(); ++j) {
    p_mean += points.weights[j] * points.p[j];
    q_mean += points.weights[j] * points.q[j];
    sum += points.weights[j];
  }
  const Eigen::Matrix2d R = rotation(fit.motion.theta);
  double along = 0.0;
  double q_spread = 0.0;
  double p_spread = 0.0;
  for (std::size_t j = 0; j < points.p.size(); ++j) {
    const Eigen::Vector2d p = points.p[j] - p_mean / sum;
    const Eigen::Vector2d q = R * (points.q[j] - q_mean / sum);
    along += points.weights[j] * q.dot(p);
    q_spread += points.weights[j] * q.squaredNorm();
    p_spread += points.weights[j] * p.squaredNorm();
  }
  if (!(q_spread > 0.0)) return {};
  // What is left of the errors when the scale is taken out; a similarity has four unknowns.
  const double squares = std::max(0.0, p_spread - along * along / q_spread);
  const double variance = squares / (2.0 * static_cast<double>(points.p.size()) - 4.0);
  return {along / q_spread, std::sqrt(variance / q_spread)};
}

void set_covariance(Registration& result, const MotionFit& fit, const MatchSet& matches,
                    const FloorFeatures& from, const FloorFeatures& to,
                    const RegistrationOptions& options) {
  const Points points = points_of(matches, fit.inliers);
  const LinearFit linear(fit.motion, points.p, points.q, points.weights);
  const CovarianceOptions& told = options.covariance;
  result.own = own_by_told(linear, fit, from.viewpoint, to.viewpoint, options);
  std::tie(result.own.bend_from, result.own.bend_to) =
      motion_bends(fit.motion, points.q, points.weights, from.viewpoint, to.viewpoint);
  result.own.scale(told.own() * told.own());
  result.shared = linear.altitude_and_tilt(from.viewpoint, to.viewpoint, told);
  result.shared.own = result.own.beside(result.shared.from, result.shared.to);
  result.covariance = result.shared.own + total_of(result.shared.from, result.shared.to);
}

}  // namespace fathom

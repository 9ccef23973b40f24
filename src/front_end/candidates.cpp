#include "fathom/front_end/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include <Eigen/Eigenvalues>

#include "fathom/core/chi_squared.hpp"

namespace fathom {

namespace {

// How far a tilt moves a footprint: what the body's vertical meets on the floor.
double aside_m(const Stance& stance) {
  if (stance.is_level()) return 0.0;
  const Eigen::Vector3d down = -stance.tilt.rotation().col(2);
  return stance.altitude_m * down.head<2>().norm() / -down.z();
}

}  // namespace

CandidateSearch::CandidateSearch(const Camera& camera, const CandidateOptions& options)
    : camera_(camera),
      options_(options),
      method_(options.method_in_force()),
      mount_m_(std::hypot(camera.model().mount_x_m, camera.model().mount_y_m)),
      quantile_(chi_squared_quantile(options.probability, 2.0)) {
  options.check();
  const Eigen::Vector2d mount{camera.model().mount_x_m, camera.model().mount_y_m};
  for (const Eigen::Vector2d& corner : camera.footprint(1.0)) {
    reach_per_metre_ = std::max(reach_per_metre_, (corner - mount).norm());
  }
  const auto corners = camera.footprint(1.0);
  side_per_metre_ = std::max((corners[1] - corners[0]).norm(), (corners[2] - corners[1]).norm());
}

// The altitude at which the footprint of a level camera reaches as far.
double CandidateSearch::level_altitude_m(const Stance& stance) const {
  if (stance.is_level()) return stance.altitude_m;
  const Eigen::Vector2d mount{camera_.model().mount_x_m, camera_.model().mount_y_m};
  double reach_m = 0.0;
  for (const Eigen::Vector2d& corner : camera_.footprint(stance)) {
    reach_m = std::max(reach_m, (corner - mount).norm());
  }
  return reach_m / reach_per_metre_;
}

// Footprints further apart than both reach need no polygons.
double CandidateSearch::overlap(const Pose& motion, const Stance& from, const Stance& to) const {
  const double reach_m =
      reach_per_metre_ * (level_altitude_m(from) + level_altitude_m(to)) + 2.0 * mount_m_;
  if (!(motion.position().norm() <= reach_m)) return 0.0;
  return footprint_overlap(camera_, from, to, motion);
}

bool CandidateSearch::by_overlap() const {
  return method_ == CandidateMethod::overlap || method_ == CandidateMethod::possible_overlap;
}

// Further apart no two pictures share min_overlap of a footprint, as long as they lie alike; turned
// to each other they may, by little.
double CandidateSearch::reach_m(const Stance& from, const Stance& newest) const {
  if (!by_overlap()) return *options_.max_distance_m;
  const double lower_m = std::min(from.altitude_m, newest.altitude_m);
  return side_per_metre_ *
             (0.5 * (from.altitude_m + newest.altitude_m) - options_.min_overlap * lower_m) +
         2.0 * mount_m_ + aside_m(from) + aside_m(newest);
}

bool CandidateSearch::accepts(const Pose& step, const Stance& from, const Stance& to) const {
  return by_overlap() ? overlap(step, from, to) >= options_.min_overlap
                      : step.position().norm() <= *options_.max_distance_m;
}

// Positions further apart than this radius are of no candidate, so the grid's cells are as large.
std::vector<std::size_t> CandidateSearch::within_reach(const TrajectoryView& trajectory,
                                                       std::span<const Stance> stances) {
  for (; stances_ < stances.size(); ++stances_) {
    highest_m_ = std::max(highest_m_, level_altitude_m(stances[stances_]));
  }
  const double radius_m =
      by_overlap()
          ? reach_per_metre_ * (highest_m_ + level_altitude_m(stances.back())) + 2.0 * mount_m_
          : *options_.max_distance_m;
  if (!grid_) grid_.emplace(radius_m > 0.0 ? radius_m : 1.0);
  grid_->follow(trajectory);
  return grid_->near(trajectory.pose(stances.size() - 1).position(), radius_m);
}

bool CandidateSearch::is_candidate(const Pose& from, const Pose& newest, const Stance& stance_from,
                                   const Stance& stance_newest) const {
  return by_overlap()
             ? overlap(between(from, newest), stance_from, stance_newest) >= options_.min_overlap
             : (from.position() - newest.position()).norm() <= *options_.max_distance_m;
}

// Those that the confidence ellipse of their motion reaches.
std::vector<CandidateSearch::Chance> CandidateSearch::perhaps_near(
    const std::vector<UncertainPose>& motions, std::span<const Stance> stances,
    std::size_t end) const {
  std::vector<Chance> found;
  for (std::size_t k = 0; k < end; ++k) {
    const UncertainPose& motion = motions[k];
    const Eigen::Vector2d d = motion.mean.position();
    const Eigen::Matrix2d S = motion.covariance.topLeftCorner<2, 2>();
    const double radius_m = reach_m(stances[k], stances.back());
    // No eigenvalue is larger than the trace: most are told by it.
    const double gap_m = d.norm() - radius_m;
    if (gap_m > 0.0 && gap_m * gap_m > quantile_ * S.trace()) continue;
    const double squared_sigmas = squared_distance_to_disc(d, S, radius_m);
    if (squared_sigmas <= quantile_) found.push_back({k, squared_sigmas});
  }
  return found;
}

// Those found by the estimate itself are as near as can be.
std::vector<CandidateSearch::Chance> CandidateSearch::near_as_estimated(
    const TrajectoryView& trajectory, std::span<const Stance> stances, std::size_t end) {
  const std::size_t newest = stances.size() - 1;
  const Pose pose = trajectory.pose(newest);
  std::vector<Chance> found;
  for (const std::size_t k : within_reach(trajectory, stances)) {
    if (k >= end) break;
    if (is_candidate(trajectory.pose(k), pose, stances[k], stances[newest])) {
      found.push_back({k, 0.0});
    }
  }
  return found;
}

std::optional<std::size_t> CandidateSearch::limit() const {
  if (method_ == CandidateMethod::possible_overlap) return options_.budget;
  return options_.max_per_keyframe;
}

std::vector<CandidateSearch::Chance> CandidateSearch::united(const std::vector<Chance>& near,
                                                             const std::vector<Chance>& perhaps) {
  std::vector<Chance> both;
  std::ranges::set_union(near, perhaps, std::back_inserter(both), {}, &Chance::keyframe,
                         &Chance::keyframe);
  return both;
}

Candidates CandidateSearch::find(const TrajectoryView& trajectory, std::span<const Stance> stances,
                                 std::size_t end, std::span<const std::size_t> holes) {
  const std::size_t newest = stances.size() - 1;
  stretches_.extend(stances.size(), holes);
  close_holes(trajectory, stances);
  over_holes_.clear();
  Candidates result;
  result.asked_covariances = options_.asks_covariances() || has_open_holes();
  std::vector<Chance> found = near_as_estimated(trajectory, stances, end);
  if (result.asked_covariances) {
    if (const auto motions = trajectory.motions_to_newest()) {
      close_holes(*motions, stances);
      std::vector<Chance> perhaps = perhaps_near(*motions, stances, end);
      take_over_holes(perhaps, found, newest);
      if (options_.asks_covariances()) found = united(found, perhaps);
    }
  }
  const std::optional<std::size_t> most = places(newest);
  result.keyframes = best(trajectory, stances, found, most);
  result.left_out = found.size() - result.keyframes.size();
  places_over_holes_ = static_cast<std::size_t>(options_.hole_budget);
  if (most) places_over_holes_ = std::min(places_over_holes_, *limit() - result.keyframes.size());
  return result;
}

// The nearest point is p = (1 + λ S)⁻¹ d with the multiplier λ ≥ 0 that puts it on the circle. In
// the axes of S, with its eigenvalues over the largest one, s, as σ and t = λ s / (1 + λ s):
// p_i = d_i (1 − t) / (1 − t + t σ_i), which falls as t rises from 0 to 1, so t is halved in.
double squared_distance_to_disc(const Eigen::Vector2d& d, const Eigen::Matrix2d& S,
                                double radius_m) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (!d.allFinite()) return kInfinity;
  if (d.norm() <= radius_m) return 0.0;
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes;
  axes.computeDirect(S);
  const double s = axes.eigenvalues().maxCoeff();
  if (!(s > 0.0) || !std::isfinite(s)) return kInfinity;
  const Eigen::Array2d sigma = (axes.eigenvalues().array() / s).max(0.0);
  const Eigen::Array2d along = (axes.eigenvectors().transpose() * d).array();
  const auto norm_at = [&](double t) {
    return (along * (1.0 - t) / (1.0 - t + t * sigma)).matrix().norm();
  };
  double low = 0.0;
  double high = 1.0;
  constexpr int kHalvings = 50;
  for (int i = 0; i < kHalvings; ++i) {
    const double t = 0.5 * (low + high);
    (norm_at(t) > radius_m ? low : high) = t;
  }
  // A direction without uncertainty can keep it out for good.
  if (radius_m > 0.0 && norm_at(low) > radius_m * (1.0 + 1e-6)) return kInfinity;
  const Eigen::Array2d moved = along * low / (1.0 - low + low * sigma);
  return (moved.square() * sigma).sum() / s;
}

}  // namespace fathom

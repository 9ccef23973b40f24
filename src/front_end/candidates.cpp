#include "fathom/front_end/candidates.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <tuple>
#include <utility>

#include <Eigen/Eigenvalues>

#include "fathom/core/chi_squared.hpp"

namespace fathom {

void CandidateOptions::describe(OptionTable& table) {
  table.enumeration("method", method,
                    {{"distance", CandidateMethod::distance},
                     {"mahalanobis", CandidateMethod::mahalanobis},
                     {"overlap", CandidateMethod::overlap}},
                    "loop candidates: near as estimated; perhaps near, by the estimator's "
                    "uncertainty; or pictures that overlap");
  table.real("max_distance_m", max_distance_m, Range::at_least(0.0), "m",
             "distance, mahalanobis: keyframes within this distance of the newest, as estimated");
  table.real("probability", probability, Range::between(1e-6, 0.999999999999), "",
             "mahalanobis: and those whose confidence ellipse of so much reaches within it");
  table.real("min_overlap", min_overlap, Range{0.0, 1.0, true}, "",
             "overlap: share of the smaller footprint that both pictures see, as estimated");
  table.integer_or_off("max_per_keyframe", max_per_keyframe, Range::at_least(1), "keyframes",
                       "so many candidates at most, those of most overlap as estimated");
}

std::vector<std::string> CandidateOptions::ignored_keys() const {
  switch (method) {
    case CandidateMethod::mahalanobis:
      return {"min_overlap"};
    case CandidateMethod::overlap:
      return {"max_distance_m", "probability"};
    case CandidateMethod::distance:
      break;
  }
  return {"probability", "min_overlap"};
}

CandidateSearch::CandidateSearch(const Camera& camera, const CandidateOptions& options)
    : camera_(camera),
      options_(options),
      mount_m_(std::hypot(camera.model().mount_x_m, camera.model().mount_y_m)),
      quantile_(chi_squared_quantile(options.probability, 2.0)) {
  const Eigen::Vector2d mount{camera.model().mount_x_m, camera.model().mount_y_m};
  for (const Eigen::Vector2d& corner : camera.footprint(1.0)) {
    reach_per_metre_ = std::max(reach_per_metre_, (corner - mount).norm());
  }
}

// Footprints further apart than both reach need no polygons.
double CandidateSearch::overlap(const Pose& motion, double altitude_from_m,
                                double altitude_to_m) const {
  const double reach_m = reach_per_metre_ * (altitude_from_m + altitude_to_m) + 2.0 * mount_m_;
  if (!(motion.position().norm() <= reach_m)) return 0.0;
  return footprint_overlap(camera_, altitude_from_m, altitude_to_m, motion);
}

bool CandidateSearch::accepts(const Pose& step, double altitude_from_m,
                              double altitude_to_m) const {
  return options_.method == CandidateMethod::overlap
             ? overlap(step, altitude_from_m, altitude_to_m) >= options_.min_overlap
             : step.position().norm() <= options_.max_distance_m;
}

// Positions further apart than this radius are of no candidate, so the grid's cells are as large.
std::vector<std::size_t> CandidateSearch::within_reach(const TrajectoryView& trajectory,
                                                       std::span<const double> altitudes_m) {
  for (; altitudes_ < altitudes_m.size(); ++altitudes_) {
    highest_m_ = std::max(highest_m_, altitudes_m[altitudes_]);
  }
  const double radius_m =
      options_.method == CandidateMethod::overlap
          ? reach_per_metre_ * (highest_m_ + altitudes_m.back()) + 2.0 * mount_m_
          : options_.max_distance_m;
  if (!grid_) grid_.emplace(radius_m > 0.0 ? radius_m : 1.0);
  grid_->follow(trajectory);
  return grid_->near(trajectory.pose(altitudes_m.size() - 1).position(), radius_m);
}

bool CandidateSearch::is_candidate(const Pose& from, const Pose& newest, double altitude_from_m,
                                   double altitude_newest_m) const {
  return options_.method == CandidateMethod::overlap
             ? overlap(between(from, newest), altitude_from_m, altitude_newest_m) >=
                   options_.min_overlap
             : (from.position() - newest.position()).norm() <= options_.max_distance_m;
}

std::vector<std::size_t> CandidateSearch::perhaps_near(const TrajectoryView& trajectory,
                                                       std::size_t end) const {
  const auto motions = trajectory.motions_to_newest();
  std::vector<std::size_t> found;
  if (!motions) return found;
  for (std::size_t k = 0; k < end; ++k) {
    const UncertainPose& motion = (*motions)[k];
    const Eigen::Vector2d d = motion.mean.position();
    const Eigen::Matrix2d S = motion.covariance.topLeftCorner<2, 2>();
    // No eigenvalue is larger than the trace: most are told by it.
    const double gap_m = d.norm() - options_.max_distance_m;
    if (gap_m > 0.0 && gap_m * gap_m > quantile_ * S.trace()) continue;
    if (squared_distance_to_disc(d, S, options_.max_distance_m) <= quantile_) found.push_back(k);
  }
  return found;
}

Candidates CandidateSearch::find(const TrajectoryView& trajectory,
                                 std::span<const double> altitudes_m, std::size_t end) {
  const std::size_t newest = altitudes_m.size() - 1;
  const Pose pose = trajectory.pose(newest);
  std::vector<std::size_t> found;
  for (const std::size_t k : within_reach(trajectory, altitudes_m)) {
    if (k >= end) break;
    if (is_candidate(trajectory.pose(k), pose, altitudes_m[k], altitudes_m[newest])) {
      found.push_back(k);
    }
  }
  if (options_.method == CandidateMethod::mahalanobis) {
    const std::vector<std::size_t> near = std::exchange(found, {});
    std::ranges::set_union(near, perhaps_near(trajectory, end), std::back_inserter(found));
  }
  return best(trajectory, altitudes_m, std::move(found));
}

// Most overlap first, then the nearest, then the earliest.
Candidates CandidateSearch::best(const TrajectoryView& trajectory,
                                 std::span<const double> altitudes_m,
                                 std::vector<std::size_t> keyframes) const {
  const std::size_t found = keyframes.size();
  const auto budget = static_cast<std::size_t>(options_.max_per_keyframe.value_or(0));
  if (!options_.max_per_keyframe || found <= budget) return {std::move(keyframes), 0};
  const std::size_t newest = altitudes_m.size() - 1;
  std::vector<std::tuple<double, double, std::size_t>> order;
  for (const std::size_t k : keyframes) {
    const Pose motion = between(trajectory.pose(k), trajectory.pose(newest));
    order.emplace_back(-overlap(motion, altitudes_m[k], altitudes_m[newest]),
                       motion.position().norm(), k);
  }
  std::sort(order.begin(), order.end());
  keyframes.resize(budget);
  for (std::size_t i = 0; i < budget; ++i) keyframes[i] = std::get<2>(order[i]);
  std::sort(keyframes.begin(), keyframes.end());
  return {std::move(keyframes), found - budget};
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

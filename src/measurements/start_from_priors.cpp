#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include <Eigen/Cholesky>

#include "fathom/core/input_error.hpp"
#include "fathom/geometry/covariance.hpp"
#include "fathom/measurements/g2o.hpp"

namespace fathom {
namespace {

using Priors = std::vector<AbsolutePose>;

Eigen::Matrix3d in_world_axes(const AbsolutePose& z) {
  return transport(planar_rotation(z.pose.theta), z.information);
}

// Measurements that add up: the residual is linear in the pose but for the wrap of its heading.
struct Sum {
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();  ///< world axes
  int rank = 0;

  Sum with(const AbsolutePose& z) const {
    Sum sum{information + in_world_axes(z), 0};
    sum.rank = rows_of(sum.information).rank;
    return sum;
  }
};

// Those that say something that those before do not: no two of them can contradict each other, so
// that a pose meets all.
std::pair<Priors, Priors> independent(const Priors& priors) {
  std::pair<Priors, Priors> split;
  Sum sum;
  for (const AbsolutePose& z : priors) {
    const Sum with = sum.with(z);
    const int own = rows_of(z.information).rank;
    const bool adds = own > 0 && with.rank == sum.rank + own;
    (adds ? split.first : split.second).push_back(z);
    if (adds) sum = with;
  }
  return split;
}

// Σ Ωᵢ (x − xᵢ) = 0, headings about that of the measurement that says most of it.
StartPose fused(const Priors& priors) {
  const auto heading_of = [](const AbsolutePose& z) { return z.information(2, 2); };
  const Pose about = std::ranges::max_element(priors, {}, heading_of)->pose;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  Eigen::Vector3d right = Eigen::Vector3d::Zero();
  for (const AbsolutePose& z : priors) {
    const Eigen::Matrix3d information = in_world_axes(z);
    sum += information;
    const Eigen::Vector3d offset(z.pose.x - about.x, z.pose.y - about.y,
                                 wrap_angle(z.pose.theta - about.theta));
    right += information * offset;
  }
  StartPose start;
  start.covariance = symmetric_inverse(sum);
  const Eigen::Vector3d offset = start.covariance * right;
  start.pose = {about.x + offset.x(), about.y + offset.y(), wrap_angle(about.theta + offset.z())};
  return start;
}

// What measurements of one pose leave open; empty: nothing. A heading known to no more than half a
// turn is none.
std::string missing(const Priors& priors) {
  Sum sum;
  for (const AbsolutePose& z : priors) sum = sum.with(z);
  if (sum.rank == 3) {
    const double sigma_rad = std::sqrt(symmetric_inverse(sum.information)(2, 2));
    return sigma_rad <= std::numbers::pi ? "" : "heading";
  }
  Eigen::Matrix3d position = sum.information;
  position(2, 2) += std::max(1.0, position(2, 2));
  const bool has_position = is_positive_definite(position);
  const bool has_heading = sum.information(2, 2) > 0.0;
  if (has_position) return "heading";
  return has_heading ? "position" : "position and heading";
}

MeasurementLog with_start(const MeasurementLog& log, const StartPose& start, const Priors& left) {
  MeasurementLog result(start);
  for (std::size_t k = 0; k < log.size(); ++k) {
    const KeyframeMeasurements& arrival = log.arrival(k);
    if (k > 0) result.add_keyframe(arrival.step);
    for (const RelativePose& z : arrival.registrations) result.add_registration(z);
    for (const AbsolutePose& z : k == 0 ? left : arrival.absolute) result.add_absolute(z);
  }
  result.ids = log.ids;
  result.guess = log.guess;
  result.self_edges = log.self_edges;
  return result;
}

}  // namespace

MeasurementLog with_start_of_priors(const MeasurementLog& log, const std::string& name) {
  if (!log.start().is_free) return log;
  const Priors& priors = log.arrival(0).absolute;
  const auto [taken, left] = independent(priors);
  const std::string id = std::to_string(log.ids.empty() ? 0 : log.ids[0]);
  const std::string what_not = missing(taken);
  if (what_not.empty()) return with_start(log, fused(taken), left);
  if (missing(priors).empty()) {
    throw InputError(name, "the priors of pose " + id +
                               " say its pose only where they overlap, and a filter starts from "
                               "one; expected one EDGE_PRIOR_SE2 in their place, or --mode batch");
  }
  throw InputError(name,
                   fmt::format("no vertex is fixed, and the priors of the first pose, {0}, do not "
                               "say its {1}, which a run keyframe by keyframe starts from; "
                               "expected an EDGE_PRIOR_SE2 of it, FIX {0}, or --mode batch",
                               id, what_not));
}

}  // namespace fathom

// Candidates over holes in dead reckoning that nothing has closed.

#include <algorithm>
#include <cmath>

#include "fathom/front_end/candidates.hpp"

namespace fathom {

// Whether the confidence ellipse's longer half-axis is beyond reach. So is one that is no number.
bool CandidateSearch::is_wide(const UncertainPose& motion, double reach_m) const {
  const Eigen::Matrix3d& S = motion.covariance;
  const double largest = 0.5 * (S(0, 0) + S(1, 1)) + std::hypot(0.5 * (S(0, 0) - S(1, 1)), S(0, 1));
  return !(quantile_ * largest <= reach_m * reach_m);
}

void CandidateSearch::note(std::span<const RelativePose> registrations) {
  if (!has_open_holes()) return;
  for (const RelativePose& z : registrations) {
    if (!stretches_.are_joined(z.from, z.to)) noted_.push_back(z);
  }
}

// By registrations, unless the estimate has rejected them.
void CandidateSearch::close_holes(const TrajectoryView& trajectory,
                                  std::span<const Stance> stances) {
  for (const RelativePose& z : noted_) {
    const Pose motion = between(trajectory.pose(z.from), trajectory.pose(z.to));
    const double error_m = (motion.position() - z.motion.position()).norm();
    if (error_m <= reach_m(stances[z.from], stances[z.to])) stretches_.join(z.from, z.to);
  }
  noted_.clear();
}

// By fixes, or by how narrow the hole was declared; for good.
void CandidateSearch::close_holes(const std::vector<UncertainPose>& motions,
                                  std::span<const Stance> stances) {
  const std::size_t newest = stances.size() - 1;
  for (std::size_t k = 0; k < newest && has_open_holes(); ++k) {
    if (stretches_.are_joined(k, newest)) continue;
    if (!is_wide(motions[k], reach_m(stances[k], stances[newest]))) stretches_.join(k, newest);
  }
}

// From `perhaps` to those over holes, but for the ones that are candidates as estimated.
void CandidateSearch::take_over_holes(std::vector<Chance>& perhaps, const std::vector<Chance>& near,
                                      std::size_t newest) {
  if (!has_open_holes()) return;
  const auto over = std::stable_partition(
      perhaps.begin(), perhaps.end(),
      [&](const Chance& candidate) { return stretches_.are_joined(candidate.keyframe, newest); });
  for (auto candidate = over; candidate != perhaps.end(); ++candidate) {
    if (!std::ranges::binary_search(near, candidate->keyframe, {}, &Chance::keyframe)) {
      over_holes_.push_back(candidate->keyframe);
    }
  }
  perhaps.erase(over, perhaps.end());
}

// Of candidates that are tried first: half of all where there are others over holes, an odd one in
// every other turn; all where these need less.
std::optional<std::size_t> CandidateSearch::places(std::size_t newest) const {
  const std::optional<std::size_t> most = limit();
  if (!most) return std::nullopt;
  const auto budget = static_cast<std::size_t>(options_.hole_budget);
  const std::size_t half = (*most + newest % 2) / 2;
  return *most - std::min({half, budget, over_holes_.size()});
}

Candidates CandidateSearch::over_holes(std::span<const RelativePose> found) const {
  if (over_holes_.empty()) return {};
  const std::size_t newest = stretches_.size() - 1;
  JoinedStretches joined = stretches_;
  for (const RelativePose& z : found) joined.join(z.from, z.to);
  std::vector<std::size_t> open = over_holes_;
  std::erase_if(open, [&](std::size_t k) { return joined.are_joined(k, newest); });
  Candidates result;
  for (const std::size_t place : in_turn(open.size(), places_over_holes_, newest)) {
    result.keyframes.push_back(open[place]);
  }
  result.left_out = open.size() - result.keyframes.size();
  return result;
}

}  // namespace fathom

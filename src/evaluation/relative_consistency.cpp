#include "fathom/evaluation/relative_consistency.hpp"

#include <cmath>
#include <utility>

#include "checks.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {

std::vector<JudgedMotions> motions_to_judge(std::span<const Pose> reference,
                                            const MetricOptions& options) {
  std::vector<JudgedMotions> groups;
  const auto add = [&](MotionsOver over, double amount, std::vector<KeyframePair> pairs) {
    if (!pairs.empty()) groups.push_back({over, amount, std::move(pairs)});
  };
  if (!all_finite(reference)) return groups;
  const auto most = static_cast<std::size_t>(options.relative_pairs);
  for (const double amount : options.rpe_keyframes) {
    const auto separation = static_cast<std::size_t>(amount);
    add(MotionsOver::keyframes, amount,
        thinned(pairs_over_keyframes(reference.size(), separation), most));
  }
  for (const double amount : options.rpe_distances_m) {
    add(MotionsOver::distance_m, amount, thinned(pairs_over_distance(reference, amount), most));
  }
  add(MotionsOver::anchors, static_cast<double>(options.anchors),
      pairs_with_anchors(reference.size(), static_cast<std::size_t>(options.anchors), most));
  return groups;
}

std::optional<double> relative_anees(std::span<const Pose> estimate,
                                     std::span<const Pose> reference,
                                     const JudgedMotions& motions) {
  require_same_length(estimate.size(), reference.size(), "the reference");
  if (motions.pairs.empty() || motions.covariances.empty()) return std::nullopt;
  require_same_length(motions.pairs.size(), motions.covariances.size(), "covariances of motions");
  if (!all_finite(estimate) || !all_finite(reference)) return std::nullopt;
  double sum = 0.0;
  for (std::size_t m = 0; m < motions.pairs.size(); ++m) {
    const auto& [from, to] = motions.pairs[m];
    const Eigen::Matrix3d& P = motions.covariances[m];
    if (!is_positive_definite(P)) return std::nullopt;
    const Pose h = between(estimate[from], estimate[to]);
    const Pose r = between(reference[from], reference[to]);
    const Eigen::Vector3d e(h.x - r.x, h.y - r.y, wrap_angle(h.theta - r.theta));
    sum += e.dot(symmetric_inverse(P) * e);
  }
  const double anees = sum / (3.0 * static_cast<double>(motions.pairs.size()));
  return std::isfinite(anees) ? std::optional(anees) : std::nullopt;
}

}  // namespace fathom

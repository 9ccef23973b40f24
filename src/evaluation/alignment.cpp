#include "fathom/evaluation/alignment.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include "checks.hpp"

namespace fathom {
namespace {

Eigen::Vector2d centroid(std::span<const Pose> poses) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (const Pose& pose : poses) sum += pose.position();
  return sum / static_cast<double>(poses.size());
}

/// Sums over the centred positions p′ of the estimate and q′ of the reference.
struct ProductSums {
  double dot = 0.0;    ///< Σ p′ · q′
  double cross = 0.0;  ///< Σ p′ × q′
  double estimate_spread = 0.0;
  double reference_spread = 0.0;
};

ProductSums product_sums(std::span<const Pose> estimate, const Eigen::Vector2d& estimate_centre,
                         std::span<const Pose> reference, const Eigen::Vector2d& reference_centre) {
  ProductSums sums;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    const Eigen::Vector2d p = estimate[k].position() - estimate_centre;
    const Eigen::Vector2d q = reference[k].position() - reference_centre;
    sums.dot += p.dot(q);
    sums.cross += p.x() * q.y() - p.y() * q.x();
    sums.estimate_spread += p.squaredNorm();
    sums.reference_spread += q.squaredNorm();
  }
  return sums;
}

// A spread that is the rounding of large coordinates is no spread.
bool is_one_place(double spread, std::span<const Pose> poses) {
  double largest = 0.0;
  for (const Pose& pose : poses) {
    largest = std::max({largest, std::abs(pose.x), std::abs(pose.y)});
  }
  constexpr double kRounding = 1e-13;
  return std::sqrt(spread / static_cast<double>(poses.size())) <= kRounding * largest;
}

// Also open where the positions of one list mirror the other's evenly: the sums then cancel.
bool positions_fix_rotation(const ProductSums& sums, std::span<const Pose> estimate,
                            std::span<const Pose> reference) {
  if (is_one_place(sums.estimate_spread, estimate)) return false;
  if (is_one_place(sums.reference_spread, reference)) return false;
  constexpr double kCancelled = 1e-12;
  return std::hypot(sums.dot, sums.cross) >
         kCancelled * std::sqrt(sums.estimate_spread) * std::sqrt(sums.reference_spread);
}

double mean_heading_difference(std::span<const Pose> estimate, std::span<const Pose> reference) {
  double cosines = 0.0;
  double sines = 0.0;
  for (std::size_t k = 0; k < estimate.size(); ++k) {
    cosines += std::cos(reference[k].theta - estimate[k].theta);
    sines += std::sin(reference[k].theta - estimate[k].theta);
  }
  return std::atan2(sines, cosines);
}

Pose least_squares_motion(std::span<const Pose> estimate, std::span<const Pose> reference) {
  const Eigen::Vector2d estimate_centre = centroid(estimate);
  const Eigen::Vector2d reference_centre = centroid(reference);
  const ProductSums sums = product_sums(estimate, estimate_centre, reference, reference_centre);
  const bool not_a_number = std::isnan(sums.dot) || std::isnan(sums.cross);
  const double theta = not_a_number || positions_fix_rotation(sums, estimate, reference)
                           ? std::atan2(sums.cross, sums.dot)
                           : mean_heading_difference(estimate, reference);
  const Eigen::Vector2d shift = reference_centre - rotation(theta) * estimate_centre;
  return {shift.x(), shift.y(), wrap_angle(theta)};
}

}  // namespace

const std::vector<std::pair<std::string, Alignment>>& alignment_names() {
  static const std::vector<std::pair<std::string, Alignment>> names{
      {"none", Alignment::none}, {"origin", Alignment::origin}, {"se2", Alignment::se2}};
  return names;
}

std::string name_of(Alignment alignment) {
  for (const auto& [name, value] : alignment_names()) {
    if (value == alignment) return name;
  }
  return "none";
}

Pose alignment_motion(std::span<const Pose> estimate, std::span<const Pose> reference,
                      Alignment alignment) {
  require_same_length(estimate.size(), reference.size(), "the reference");
  if (estimate.empty() || alignment == Alignment::none) return {};
  if (alignment == Alignment::origin) return compose(reference[0], inverse(estimate[0]));
  return least_squares_motion(estimate, reference);
}

Aligned align(std::span<const Pose> estimate, std::span<const Pose> reference,
              Alignment alignment) {
  Aligned aligned;
  aligned.motion_reference_estimate = alignment_motion(estimate, reference, alignment);
  aligned.poses.assign(estimate.begin(), estimate.end());
  if (alignment == Alignment::none) return aligned;
  for (Pose& pose : aligned.poses) pose = compose(aligned.motion_reference_estimate, pose);
  return aligned;
}

}  // namespace fathom

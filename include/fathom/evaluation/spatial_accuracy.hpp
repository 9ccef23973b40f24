#pragma once

#include <optional>
#include <span>
#include <vector>

#include "fathom/evaluation/accuracy.hpp"
#include "fathom/evaluation/association.hpp"
#include "fathom/evaluation/spatial_alignment.hpp"
#include "fathom/geometry/plane.hpp"

namespace fathom {

/// A trajectory in space on its plane.
struct ProjectedTrajectory {
  Plane plane = Plane::xy;
  PlaneAxes axes;
  Projection projection;
};

/// An estimate in space beside its reference: both on their planes, and the errors there.
struct SpatialAccuracy {
  ProjectedTrajectory estimate;
  ProjectedTrajectory reference;
  BodyAxes body;  ///< as the reference has it; headings of both are of this axis
  /// Whether about the same axis of the body points up in both. If not, as with the axes of a
  /// camera in one and those of a vehicle in the other, headings are of different axes.
  bool is_mounted_alike = true;
  AssociatedPoses poses;  ///< on the plane, before the alignment
  /// After it; absent as of accuracy().
  std::optional<Accuracy> accuracy;
  std::vector<double> position_errors_m;   ///< on the plane, after the alignment
  std::vector<double> heading_errors_rad;  ///< likewise, without sign
  std::vector<double> height_errors_m;     ///< after the alignment, estimate − reference
};

/// The planes that the two are projected onto.
struct PlanePair {
  Plane estimate = Plane::xy;
  Plane reference = Plane::xy;
};

/// Projects both, each onto its plane, then aligns and compares them there. The k-th poses belong
/// together. Throws InputError where the lists differ in length or are empty, and where positions
/// on a line leave Plane::fit open.
SpatialAccuracy spatial_accuracy(std::span<const StampedSpatialPose> estimate,
                                 std::span<const StampedSpatialPose> reference, PlanePair planes,
                                 SpatialAlignment alignment);

/// Distances in space: on the plane, and in height. Of lists of one length.
std::vector<double> with_heights(std::span<const double> position_errors_m,
                                 std::span<const double> height_errors_m);

}  // namespace fathom

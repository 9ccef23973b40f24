#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "fathom/evaluation/accuracy.hpp"
#include "fathom/evaluation/association.hpp"
#include "fathom/evaluation/spatial_alignment.hpp"
#include "fathom/geometry/plane.hpp"
#include "fathom/report/table.hpp"

namespace fathom {

/// Two trajectories whose k-th poses belong together.
struct SpatialPairs {
  std::vector<StampedSpatialPose> estimate;
  std::vector<StampedSpatialPose> reference;
  std::size_t estimate_size = 0;  ///< poses of the estimate, with and without a partner
  bool by_index = false;
};

/// A trajectory on its plane.
struct Projected {
  Plane plane = Plane::xy;
  PlaneAxes axes;
  Projection projection;
};

/// An estimate beside its reference.
struct Judged {
  Projected estimate;
  Projected reference;
  AssociatedPoses poses;
  std::optional<Accuracy> accuracy;        ///< absent where the alignment leaves no error
  std::vector<double> position_errors_m;   ///< after the alignment
  std::vector<double> heading_errors_rad;  ///< without sign
  std::vector<double> height_errors_m;     ///< with sign
  std::vector<std::string> warnings;
};

/// Projects and compares; `name` is the estimate's in messages. Throws InputError on errors too
/// large for a number.
Judged judge(const SpatialPairs& pairs, Plane plane_of_estimate, Plane plane_of_reference,
             SpatialAlignment alignment, const std::string& name);

/// What relative errors are over.
struct RelativeLengths {
  std::vector<std::size_t> steps;
  std::vector<double> distances_m;
};

void print_judged(const Judged& judged, const SpatialPairs& pairs, const std::string& alignment,
                  const RelativeLengths& lengths);

}  // namespace fathom

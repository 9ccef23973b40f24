#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fathom/evaluation/alignment.hpp"

namespace fathom {

/// How an estimate in space is laid on its reference: a motion on the plane, and a shift of height.
/// Roll, pitch and scale are never aligned.
enum class SpatialAlignment {
  none,    ///< compared as they are
  origin,  ///< the first pose, heading and height included, is put on the reference's
  se2,     ///< Alignment::se2 on the plane; heights as they are
  /// Position and yaw, 4 degrees of freedom, as visual-inertial odometry is judged: rotation about
  /// the vertical and a shift along all three axes that minimise Σ |Rot_z(ψ) p_k + t − q_k|².
  ///
  /// As the rotation leaves heights alone, the sum is that of the plane plus Σ (p_z + t_z − q_z)²:
  /// the motion on the plane is that of `se2`, and t_z the difference of the mean heights. So
  /// errors on the plane equal those of `se2`; height errors do not.
  yaw,
};

/// Every alignment with the name it has in flags.
const std::vector<std::pair<std::string, SpatialAlignment>>& spatial_alignment_names();

/// What it does on the plane.
Alignment on_plane(SpatialAlignment alignment);

/// What it adds to the heights of the estimate. Lists of one length, in metres. Of empty lists: 0.
double height_shift_m(std::span<const double> estimate_m, std::span<const double> reference_m,
                      SpatialAlignment alignment);

}  // namespace fathom

#pragma once

#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fathom/geometry/pose.hpp"

namespace fathom {

/// How an estimate is laid on its reference before the two are compared. Scale is never aligned.
enum class Alignment {
  none,    ///< compared as they are
  origin,  ///< the estimate's first pose, with its heading, is put on the reference's
  se2,     ///< least-squares rotation and translation of the positions
};

/// Every alignment with the name it has in configurations and results.
const std::vector<std::pair<std::string, Alignment>>& alignment_names();
std::string name_of(Alignment alignment);

/// An aligned copy of an estimate and what was applied to it.
struct Aligned {
  std::vector<Pose> poses;
  /// The pose of the estimate's world in the reference's: poses[k] = motion ⊕ estimate[k].
  Pose motion_reference_estimate;
};

/// The rigid motion that lays `estimate` on `reference`: two lists of the same length whose k-th
/// poses belong together, in metres and radians.
///
/// `se2` minimises Σ |motion ⊕ p_k − q_k|² over the positions (Arun, Huang and Blostein 1987, in
/// the plane): θ = atan2(Σ p′ × q′, Σ p′ · q′) of the centred positions, a rotation by
/// construction, never a reflection. Where positions leave the rotation open (a single pose, all
/// poses at one place), it is the mean difference of the headings.
///
/// Of two empty lists: the identity. A NaN that the alignment rests on makes the motion NaN.
/// Throws InputError where the lengths differ.
Pose alignment_motion(std::span<const Pose> estimate, std::span<const Pose> reference,
                      Alignment alignment);

/// The estimate moved by alignment_motion(); with `none` the same bits. A NaN comes out as NaN.
Aligned align(std::span<const Pose> estimate, std::span<const Pose> reference, Alignment alignment);

}  // namespace fathom

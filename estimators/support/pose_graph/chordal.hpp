#pragma once

#include <span>
#include <vector>

#include "estimators/support/pose_graph/edge.hpp"
#include "estimators/support/sparse/block_cholesky.hpp"

namespace fathom::pose_graph {

/// Headings by chordal relaxation: minimise Σ w |z_k − e^{iδ} z_i|² over complex z with z₀ = 1,
/// which is linear and needs no rounding, and take the angle of each z (Carlone, Tron, Daniilidis
/// and Dellaert 2015). The heading of keyframe 0 is `first_rad`.
/// Far from keyframe 0, where noise has worn z down, they are no better than chance.
std::vector<double> chordal_headings(const sparse::Symbolic& symbolic, std::span<const Edge> edges,
                                     double first_rad);

}  // namespace fathom::pose_graph

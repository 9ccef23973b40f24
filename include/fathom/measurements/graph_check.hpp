#pragma once

#include <cstddef>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// What is in a g2o file, faults included: where read_g2o stops at the first, this goes on.
struct GraphSummary {
  std::size_t vertices = 0;  ///< lines that define one
  std::size_t poses = 0;     ///< ids in vertices or edges
  std::size_t edges = 0;     ///< that can be used
  std::size_t odometry_edges = 0;
  std::size_t loops = 0;           ///< the other edges
  std::size_t backward_loops = 0;  ///< of these, written from the later pose
  std::size_t components = 0;      ///< sets of poses that edges connect
  /// Largest and smallest standard deviation that an edge states, in its own axes.
  double smallest_sigma_m = 0.0;
  double largest_sigma_m = 0.0;
  double smallest_sigma_rad = 0.0;
  double largest_sigma_rad = 0.0;
  std::size_t badly_conditioned = 0;  ///< information with a condition number above kMaxCondition
  std::vector<std::string> faults;    ///< "FILE:LINE: what", by kind of fault, then line
};

/// Beyond it, 8 of a double's 16 digits are lost in an inversion.
inline constexpr double kMaxCondition = 1e8;

/// Throws InputError only where the file cannot be opened.
GraphSummary summarise_graph(const std::filesystem::path& path);

/// The reduced χ² at an optimum, which tells whether the information values fit the residuals.
struct InformationScale {
  double per_degree_of_freedom = 0.0;  ///< F / (3 edges − 3 free poses): about 1 expected
  double squared = 0.0;                ///< the same with every matrix Ω replaced by its square
  /// Whether Ω² explains the residuals (0.5 to 2 per degree of freedom) and Ω does not (below 0.1).
  bool looks_like_square_roots = false;
};

/// Nothing for a graph without redundancy. `optimum`: a pose per keyframe.
std::optional<InformationScale> information_scale(const MeasurementLog& log,
                                                  std::span<const Pose> optimum);

}  // namespace fathom

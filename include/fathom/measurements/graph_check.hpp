#pragma once

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Poses that edges connect, or that priors and a fixed vertex hold in one world.
struct GraphComponent {
  std::size_t poses = 0;
  std::int64_t first_id = 0;
  std::int64_t last_id = 0;
};

/// The priors of a graph, by what they say. Standard deviations are those of each by itself.
struct PriorSummary {
  std::size_t of_heading = 0;   ///< a heading alone
  std::size_t of_position = 0;  ///< a position alone, or one direction of it
  std::size_t of_both = 0;
  std::size_t of_nothing = 0;  ///< no information at all
  double smallest_sigma_m = 0.0;
  double largest_sigma_m = 0.0;
  double smallest_sigma_rad = 0.0;
  double largest_sigma_rad = 0.0;

  std::size_t count() const { return of_heading + of_position + of_both + of_nothing; }
};

/// What is in a g2o file, faults included: where read_g2o stops at the first, this goes on.
struct GraphSummary {
  std::size_t vertices = 0;  ///< lines that define one
  std::size_t poses = 0;     ///< ids in vertices or edges
  std::size_t edges = 0;     ///< that can be used
  std::size_t odometry_edges = 0;
  std::size_t holes = 0;           ///< neighbouring poses without one, in one component
  std::size_t loops = 0;           ///< the other edges
  std::size_t backward_loops = 0;  ///< of these, written from the later pose
  std::vector<GraphComponent> components;
  /// Neighbouring ids that are of two components.
  std::vector<std::pair<std::int64_t, std::int64_t>> borders;
  PriorSummary priors;
  bool is_start_fixed = true;  ///< else the priors hold the graph
  /// Largest and smallest standard deviation that an edge states, in its own axes.
  double smallest_sigma_m = 0.0;
  double largest_sigma_m = 0.0;
  double smallest_sigma_rad = 0.0;
  double largest_sigma_rad = 0.0;
  std::size_t turned_edges = 0;       ///< whose heading, as written, lies beyond 2π
  std::size_t badly_conditioned = 0;  ///< information with a condition number above kMaxCondition
  std::vector<std::string> faults;    ///< "FILE:LINE: what", by kind of fault, then line
};

/// Beyond it, 8 of a double's 16 digits are lost in an inversion.
inline constexpr double kMaxCondition = 1e8;

/// Throws InputError only where the file cannot be opened.
GraphSummary summarise_graph(const std::filesystem::path& path, const GraphOptions& options = {});

/// The reduced χ² at an optimum, which tells whether the information values fit the residuals.
struct InformationScale {
  double per_degree_of_freedom = 0.0;  ///< F / degrees_of_freedom(log): about 1 expected
  double squared = 0.0;                ///< the same with every matrix Ω replaced by its square
  /// Whether Ω² explains the residuals (0.5 to 2 per degree of freedom) and Ω does not (below 0.1).
  bool looks_like_square_roots = false;
};

/// Nothing for a graph without redundancy. `optimum`: a pose per keyframe.
std::optional<InformationScale> information_scale(const MeasurementLog& log,
                                                  std::span<const Pose> optimum);

}  // namespace fathom

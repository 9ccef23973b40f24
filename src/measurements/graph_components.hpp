#pragma once

#include <cstddef>
#include <string>
#include <utility>
#include <vector>

#include "g2o_file.hpp"

namespace fathom {

/// The keyframes of a file in the sets that its measurements tie together: by edges, and by the
/// world those that priors hold there, with that of the lowest vertex that is fixed.
struct GraphComponents {
  /// Keyframe indices, rising; by their first.
  std::vector<std::vector<std::size_t>> members;
  /// Whether something holds it in the world.
  std::vector<bool> is_held;
  /// Neighbours in the order of the ids that are of two components.
  std::vector<std::pair<std::int64_t, std::int64_t>> borders;
  /// Of every keyframe.
  std::vector<std::int64_t> ids;
};

/// References must be sound (check_references).
GraphComponents components_of(const G2oFile& file);

/// That there are several: how many poses each has, its ids, the borders, what to do.
std::string several_components(const GraphComponents& components);

/// That priors, where no vertex is fixed, leave the component that `file` holds open in the world.
void check_held(const G2oFile& file, const GraphComponents& components, std::size_t index,
                const G2oFault& fault);

/// The lines of a file that are of one component; FIX of it, too.
G2oFile component_of(const G2oFile& file, const GraphComponents& components, std::size_t index);

}  // namespace fathom

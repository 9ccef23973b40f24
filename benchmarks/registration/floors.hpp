#pragma once

#include <string>
#include <vector>

#include "settings.hpp"

namespace fathom::benchmarks {

/// A world to take pictures of.
struct Floor {
  std::string name;  ///< the kind, or the file's name without folder and ending
  World world;
};

/// Names of the floors that the settings ask for, procedural ones first.
std::vector<std::string> floor_names(const Settings& settings);

/// Draws or reads floor i of floor_names: a procedural one of 12 by 12 m, each as fine as the
/// pictures of pairs need. Throws
/// InputError.
Floor make_floor(const Settings& settings, std::size_t i);

/// The floor with the condition's relief, if any.
FloorRenderer renderer_for(const Floor& floor, const test::Condition& condition,
                           std::uint64_t seed);

}  // namespace fathom::benchmarks

#pragma once

#include <cstddef>
#include <span>
#include <string>

#include "fathom/measurements/variance_components.hpp"

namespace fathom {

/// Whether a component governs the picture of keyframe k.
bool governs(const VarianceComponent& component, std::size_t k);

/// "`found` WHAT, expected `expected`", an InputError where they differ.
void check_size(std::size_t found, std::size_t expected, const std::string& what);

/// Whether components suit a log, or InputError.
void check_components(const MeasurementLog& log, std::span<const VarianceComponent> components);

}  // namespace fathom

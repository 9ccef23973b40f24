#include "variance_checks.hpp"

#include "fathom/core/input_error.hpp"

namespace fathom {

bool governs(const VarianceComponent& component, std::size_t k) {
  return component.governed.empty() || component.governed[k];
}

void check_size(std::size_t found, std::size_t expected, const std::string& what) {
  if (found == expected) return;
  throw InputError(std::to_string(found) + " " + what + ", expected " + std::to_string(expected));
}

void check_components(const MeasurementLog& log, std::span<const VarianceComponent> components) {
  for (std::size_t j = 0; j < components.size(); ++j) {
    const VarianceComponent& component = components[j];
    if (!component.governed.empty()) {
      check_size(component.governed.size(), log.size(), "marks of governed pictures");
    }
    for (std::size_t i = 0; i < j; ++i) {
      for (std::size_t k = 0; k < log.size(); ++k) {
        if (components[i].part == component.part && governs(components[i], k) &&
            governs(component, k)) {
          throw InputError("two components govern picture " + std::to_string(k));
        }
      }
    }
  }
}

}  // namespace fathom

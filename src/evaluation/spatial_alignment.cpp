#include "fathom/evaluation/spatial_alignment.hpp"

#include "checks.hpp"

namespace fathom {

const std::vector<std::pair<std::string, SpatialAlignment>>& spatial_alignment_names() {
  static const std::vector<std::pair<std::string, SpatialAlignment>> names{
      {"none", SpatialAlignment::none},
      {"origin", SpatialAlignment::origin},
      {"se2", SpatialAlignment::se2},
      {"yaw", SpatialAlignment::yaw}};
  return names;
}

Alignment on_plane(SpatialAlignment alignment) {
  if (alignment == SpatialAlignment::none) return Alignment::none;
  return alignment == SpatialAlignment::origin ? Alignment::origin : Alignment::se2;
}

double height_shift_m(std::span<const double> estimate_m, std::span<const double> reference_m,
                      SpatialAlignment alignment) {
  require_same_length(estimate_m.size(), reference_m.size(), "the reference");
  if (estimate_m.empty()) return 0.0;
  if (alignment == SpatialAlignment::origin) return reference_m[0] - estimate_m[0];
  if (alignment != SpatialAlignment::yaw) return 0.0;
  double sum = 0.0;
  for (std::size_t k = 0; k < estimate_m.size(); ++k) sum += reference_m[k] - estimate_m[k];
  return sum / static_cast<double>(estimate_m.size());
}

}  // namespace fathom

#include "fathom/vision/distortion_model.hpp"

#include <algorithm>

#include "fathom/core/text.hpp"

namespace fathom {

std::string DistortionEntry::list() const {
  return "[" + joined(coefficients, ", ") + "]";
}

const std::vector<DistortionEntry>& distortion_models() {
  static const std::vector<DistortionEntry> entries{
      {DistortionModel::radial_tangential, "radial-tangential", {"k1", "k2", "p1", "p2", "k3"}, 4},
      {DistortionModel::equidistant, "equidistant", {"k1", "k2", "k3", "k4"}, 4},
      {DistortionModel::rational_polynomial,
       "rational_polynomial",
       {"k1", "k2", "p1", "p2", "k3", "k4", "k5", "k6"},
       8}};
  return entries;
}

const DistortionEntry& entry_of(DistortionModel model) {
  return *std::ranges::find(distortion_models(), model, &DistortionEntry::model);
}

}  // namespace fathom

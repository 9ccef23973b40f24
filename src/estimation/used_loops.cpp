#include "fathom/estimation/used_loops.hpp"

namespace fathom {

void UsedLoops::note(const UpdateReport& report) {
  for (const LoopDecision& loop : report.loops) is_used_.push_back(loop.fate == LoopFate::used);
}

std::vector<double> UsedLoops::weights(std::span<const double> of_used) const {
  std::vector<double> weights;
  weights.reserve(is_used_.size());
  std::size_t next = 0;
  for (const bool is_used : is_used_) weights.push_back(is_used ? of_used[next++] : 0.0);
  return weights;
}

}  // namespace fathom

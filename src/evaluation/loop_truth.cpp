#include "fathom/evaluation/loop_truth.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace fathom {

double TrueOverlaps::of(std::size_t i, std::size_t k) const {
  const auto key = [](const Pair& pair) {
    return std::pair<std::size_t, std::size_t>(pair.i, pair.k);
  };
  const auto found = std::ranges::lower_bound(pairs, std::pair(i, k), {}, key);
  return found != pairs.end() && key(*found) == std::pair(i, k) ? found->overlap : 0.0;
}

std::optional<double> loop_precision(std::span<const LoopDecision> loops,
                                     const TrueOverlaps& truth) {
  std::size_t used = 0;
  std::size_t right = 0;
  for (const LoopDecision& loop : loops) {
    if (loop.fate != LoopFate::used) continue;
    ++used;
    if (truth.of(std::min(loop.from, loop.to), std::max(loop.from, loop.to)) > 0.0) ++right;
  }
  if (used == 0) return std::nullopt;
  return static_cast<double>(right) / static_cast<double>(used);
}

std::optional<double> loop_recall(std::span<const LoopDecision> loops, const TrueOverlaps& truth,
                                  double recalled_overlap) {
  std::set<std::pair<std::size_t, std::size_t>> used;
  for (const LoopDecision& loop : loops) {
    if (loop.fate != LoopFate::used) continue;
    used.emplace(std::min(loop.from, loop.to), std::max(loop.from, loop.to));
  }
  std::size_t pairs = 0;
  std::size_t found = 0;
  for (const TrueOverlaps::Pair& pair : truth.pairs) {
    if (pair.overlap < recalled_overlap) continue;
    ++pairs;
    if (used.contains({pair.i, pair.k})) ++found;
  }
  if (pairs == 0) return std::nullopt;
  return static_cast<double>(found) / static_cast<double>(pairs);
}

}  // namespace fathom

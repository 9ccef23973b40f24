#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include "fathom/measurements/decision.hpp"

namespace fathom {

/// Pairs of keyframes that truly overlap: the ground truth of loop detection.
struct TrueOverlaps {
  struct Pair {
    std::uint32_t i = 0;
    std::uint32_t k = 0;
    double overlap = 0.0;  ///< 0 to 1
  };
  /// Those that overlap at all, i < k, by rising i and k: of a long survey a small part of all.
  std::vector<Pair> pairs;

  /// Of keyframes i < k.
  double of(std::size_t i, std::size_t k) const;
};

/// Share of the used loops whose pictures overlap at all; nothing without a used loop.
std::optional<double> loop_precision(std::span<const LoopDecision> loops,
                                     const TrueOverlaps& truth);

/// Share of the pairs that overlap by `recalled_overlap` or more that are used loops; nothing where
/// there is no such pair.
std::optional<double> loop_recall(std::span<const LoopDecision> loops, const TrueOverlaps& truth,
                                  double recalled_overlap);

}  // namespace fathom

#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace fathom {

/// The decision on a registration at the end of the log (LoopFate of `estimation`).
enum class LoopUse {
  used,      ///< it has a part in the estimate
  rejected,  ///< refused by a gate
  lost,      ///< let through, but its update failed
};

/// One registration of the log, with an estimator's decision on it and what is true of it. `from`
/// and `to` are keyframes.
struct JudgedLoop {
  std::size_t from = 0;
  std::size_t to = 0;
  LoopUse use = LoopUse::used;
  std::optional<double> nis;  ///< νᵀ S⁻¹ ν before the update, where the estimator had one
  double weight = 1.0;        ///< final, 0 to 1; 0 of one that is not used
  std::optional<bool> is_false;

  /// A loop is kept if its final weight is above one half.
  bool is_kept() const { return weight > 0.5; }
};

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
std::optional<double> loop_precision(std::span<const JudgedLoop> loops, const TrueOverlaps& truth);

/// Share of the pairs that overlap by `min_overlap` or more that are used loops; nothing where
/// there is no such pair.
std::optional<double> loop_recall(std::span<const JudgedLoop> loops, const TrueOverlaps& truth,
                                  double min_overlap);

}  // namespace fathom

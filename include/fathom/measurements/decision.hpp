#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <string>

namespace fathom {

/// How an update or a solve ended, and from `crashed` on how a run in a process of its own did.
/// Ordered by how bad it is: `worse` takes the later.
enum class Outcome {
  converged,
  iteration_limit,
  diverged,
  numerical_failure,
  crashed,
  timed_out,
  out_of_memory
};

inline constexpr std::array kOutcomes{
    Outcome::converged, Outcome::iteration_limit, Outcome::diverged,     Outcome::numerical_failure,
    Outcome::crashed,   Outcome::timed_out,       Outcome::out_of_memory};

std::string name_of(Outcome outcome);
Outcome worse(Outcome a, Outcome b);
/// Converged, or stopped at its iteration limit: the estimate can be used.
bool is_done(Outcome outcome);

/// The decision on one measurement: used, rejected by a gate, or lost with an update that failed.
enum class LoopFate { used, rejected, lost };

inline constexpr std::array kLoopFates{LoopFate::used, LoopFate::rejected, LoopFate::lost};

std::string name_of(LoopFate fate);

struct LoopDecision {
  std::size_t from = 0;
  std::size_t to = 0;
  LoopFate fate = LoopFate::used;
  /// Normalised innovation squared νᵀ S⁻¹ ν (3 degrees of freedom) before the update; absent where
  /// the estimator did not need it.
  std::optional<double> nis;
};

/// The decision on one absolute measurement.
struct AbsoluteDecision {
  std::size_t keyframe = 0;
  LoopFate fate = LoopFate::used;
  /// As of LoopDecision, with as many degrees of freedom as the rank of the information.
  std::optional<double> nis;
};

}  // namespace fathom

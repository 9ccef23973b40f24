#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "fathom/core/options.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Which keyframes a false loop joins (Sünderhauf and Protzel 2012; Vertigo's kinds).
enum class FalseLoopKind {
  random,  ///< any two, independently
  local,   ///< two at most `reach` keyframes apart
  grouped  ///< runs of neighbours with neighbours: perceptual aliasing
};

struct SpoilOptions {
  /// Of all loops, right and false, afterwards; 0: none is added.
  double share = 0.0;
  FalseLoopKind kind = FalseLoopKind::random;
  int group_size = 5;
  int reach = 20;  ///< keyframes
  /// Every false loop is off the true motion by one of these at least.
  double min_offset_m = 1.0;
  double min_offset_rad = 0.2;

  void describe(OptionTable& table);
};

std::string name_of(FalseLoopKind kind);

/// A log with false loops, and which of its registrations they are, in order of arrival.
struct Spoiled {
  MeasurementLog log;
  std::vector<bool> is_false;
};

/// Adds false loops to a log: round(share / (1 − share) · registrations) of them, each behind the
/// registrations of its later keyframe. A false loop says what some real loop of the log, drawn at
/// random, says of two other keyframes: its motion and information are those of that loop. Those
/// of a group agree with its first up to noise drawn from their information, as real ones would:
/// keyframes that stand to each other as `reference` has them. The same seed gives the same loops.
///
/// `reference`: the true poses or, where those are not known, the best estimate from the log as it
/// was; one a keyframe. Throws InputError where the log has no loop to copy or its keyframes leave
/// no room for false ones.
Spoiled spoil(const MeasurementLog& log, std::span<const Pose> reference,
              const SpoilOptions& options, std::uint64_t seed, std::uint64_t trial = 0);

}  // namespace fathom

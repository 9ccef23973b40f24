#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "trajectory_lines.hpp"

namespace fathom {

struct StampRule {
  double unit_s = 1.0;  ///< of the numbers in the file
  /// The command that orders the lines by time and keeps all of them. Empty: they are times alone,
  /// and must stay where they are, as the poses are in another file.
  std::string sort;
};

/// Throws InputError where the times, one a line, do not rise, and says what it comes of: stamps of
/// too few digits, several runs in one file, lines out of order, repeated rows.
void require_rising(std::span<const LineOfFile> lines, std::span<const std::int64_t> times_ns,
                    const StampRule& rule);

}  // namespace fathom

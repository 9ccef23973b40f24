#pragma once

#include <string>
#include <string_view>

#include "fathom/harness/replay.hpp"

namespace fathom {

/// A run as bytes, for another process of the same program. Of `motions` the covariances alone:
/// what was asked for is known to both.
std::string bytes_of(const Run& run);

/// The run of these bytes, which were anybody's: `log` is what was replayed, `asked` the options.
/// Throws std::runtime_error where they are not whole, or no run of this log.
Run run_of(std::string_view bytes, const MeasurementLog& log, const ReplayOptions& asked);

}  // namespace fathom

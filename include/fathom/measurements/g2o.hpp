#pragma once

#include <filesystem>
#include <string>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Reads a 2-D pose graph as a measurement log (docs/formats.md).
///
/// Understood: `VERTEX_SE2`, `EDGE_SE2`, `FIX`, TORO's `VERTEX2` and `EDGE2` (information in the
/// order xx xy yy tt xt yt), `#` comments, files without vertices, edges written backwards, several
/// edges between one pair, ids with gaps. Replay: keyframes are the ids in rising order; the first
/// edge from the id before to k is k's dead reckoning (failing one, the first written the other
/// way); every other edge is a registration that arrives with its later keyframe, in file order.
/// Keyframe 0 is fixed at its vertex, or at the identity where the file has none.
///
/// Throws InputError with file and line on anything it cannot use.
MeasurementLog read_g2o(const std::filesystem::path& path);

/// As read_g2o, of text in memory; `name` stands for the file in messages.
MeasurementLog parse_g2o(const std::string& content, const std::string& name);

/// A log in order of arrival: for each keyframe its vertex (the dead-reckoned pose), its step, its
/// registrations. Reads back to the same bits; inliers stand in a comment above their edge.
std::string to_g2o(const MeasurementLog& log);

}  // namespace fathom

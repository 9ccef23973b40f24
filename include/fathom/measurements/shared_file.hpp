#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "fathom/measurements/g2o.hpp"
#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Where what the registrations of a g2o file share stands: beside it, `.shared` in place of its
/// extension (docs/formats.md). read_g2o reads it where it is there.
std::filesystem::path shared_file_of(const std::filesystem::path& graph);

/// That file's text, where it is there.
std::optional<SharedText> shared_beside(const std::filesystem::path& graph);

/// Its content for a log; empty where nothing is told.
std::string to_shared(const MeasurementLog& log);

/// Writes a log and, where something is told, the file beside it; a file of that name from before
/// is removed where nothing is. `vertices` stand in place of the dead-reckoned poses. Throws
/// InputError.
void write_graph(const std::filesystem::path& graph, const MeasurementLog& log,
                 const std::optional<std::vector<Pose>>& vertices = {});

/// to_g2o and to_shared in one: all that estimators are given, for whoever hashes it.
std::string text_of(const MeasurementLog& log);

}  // namespace fathom

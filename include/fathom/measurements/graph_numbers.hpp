#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fathom/measurements/measurement_log.hpp"

namespace fathom {

/// Whether ids reach beyond what can be a time stamp of a trajectory, 9e9 s, as keys of 64 bits do.
bool has_large_ids(const MeasurementLog& log);

/// What stands for the poses as time stamps, in whole seconds: their ids or, where these are too
/// large, 0, 1, 2 … in the order of the ids.
std::vector<std::int64_t> stamps_of(const MeasurementLog& log);

/// CSV with the columns stamp and id, a row a pose.
std::string ids_csv(const MeasurementLog& log);

/// What a reader of the graph did with it, a sentence each: edges left out, stamps in place of ids;
/// and which measurements are so different in their information that doubles do not carry the sum.
std::vector<std::string> graph_remarks(const MeasurementLog& log);

}  // namespace fathom

#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "fathom/core/hash.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom {

/// A series as it is stored.
std::string_view bytes_of(const std::vector<double>& values);

/// Over all that is stored of a run but its series, which are added in the order of their names.
Hash hash_of(const RunRecord& run);
void add_series(Hash& hash, std::string_view name, std::string_view bytes);
std::int64_t checksum_of(const Hash& hash);

}  // namespace fathom

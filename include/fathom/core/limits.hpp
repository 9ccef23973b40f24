#pragma once

#include <cstdint>
#include <string>

namespace fathom {

/// What files may hold of which real ones may have more (docs/formats.md): rows as of a sensor of
/// 200 Hz over 14 hours; pixels, of which no camera has as many; bytes of a chunk of a bag, packed
/// and unpacked.
enum class Limit { csv_rows, picture_pixels, chunk_bytes };

/// Its default, or what the environment said at the first call: FATHOM_LIMITS=NAME=VALUE,…
/// Throws InputError where that is of no limit, or no whole number above zero.
std::uint64_t value_of(Limit limit);

/// For messages: its value, and how to set another.
std::string limit_text(Limit limit);

}  // namespace fathom

#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fathom {

/// The records of a chunk of an MCAP file: `packed` itself where `compression` is empty, else what
/// is unpacked to `room` by "lz4" or "zstd"; nothing where that are not `size` bytes. Throws
/// InputError that names the conversion for another compression, and where Fathom was built
/// without these two.
std::optional<std::string_view> unpacked_chunk(const std::string& file,
                                               const std::string& compression,
                                               std::string_view packed, std::uint64_t size,
                                               std::string& room);

}  // namespace fathom

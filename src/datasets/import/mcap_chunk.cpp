#include "mcap_chunk.hpp"

#include <cstddef>
#include <memory>

#include "fathom/core/features.hpp"
#include "fathom/core/text.hpp"
#include "ros2_metadata.hpp"

#ifdef FATHOM_COMPRESSION
#include <lz4frame.h>
#include <zstd.h>
#endif

namespace fathom {
namespace {

#ifdef FATHOM_COMPRESSION

struct FreeLz4 {
  void operator()(LZ4F_dctx* context) const { LZ4F_freeDecompressionContext(context); }
};

bool unpack_lz4(std::string_view packed, std::string& room) {
  LZ4F_dctx* made = nullptr;
  if (LZ4F_isError(LZ4F_createDecompressionContext(&made, LZ4F_VERSION)) != 0) return false;
  const std::unique_ptr<LZ4F_dctx, FreeLz4> context(made);
  std::size_t written = 0;
  std::size_t taken = 0;
  while (true) {
    std::size_t more = room.size() - written;
    std::size_t bytes = packed.size() - taken;
    const std::size_t left = LZ4F_decompress(context.get(), room.data() + written, &more,
                                             packed.data() + taken, &bytes, nullptr);
    written += more;
    taken += bytes;
    if (left == 0) return written == room.size() && taken == packed.size();
    if (LZ4F_isError(left) != 0 || (more == 0 && bytes == 0)) return false;
  }
}

bool unpack(const std::string& compression, std::string_view packed, std::string& room) {
  if (compression == "lz4") return unpack_lz4(packed, room);
  return ZSTD_decompress(room.data(), room.size(), packed.data(), packed.size()) == room.size();
}

#else

bool unpack(const std::string& /*compression*/, std::string_view /*packed*/,
            std::string& /*room*/) {
  return false;
}

#endif

}  // namespace

std::optional<std::string_view> unpacked_chunk(const std::string& file,
                                               const std::string& compression,
                                               std::string_view packed, std::uint64_t size,
                                               std::string& room) {
  if (compression.empty()) {
    if (packed.size() != size) return std::nullopt;
    return packed;
  }
  const std::string what = "has chunks compressed by " + in_quotes(compression);
  if (compression != "lz4" && compression != "zstd") {
    refuse_compressed(file, what + ", expected lz4 or zstd");
  }
  if (!feature("compression").is_built) {
    refuse_compressed(file, what + "; " + refusal_without("compression"));
  }
  room.resize(size);
  if (!unpack(compression, packed, room)) return std::nullopt;
  return room;
}

}  // namespace fathom

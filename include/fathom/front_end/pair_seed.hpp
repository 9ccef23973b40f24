#pragma once

#include <cstddef>
#include <cstdint>

#include "fathom/core/random.hpp"

namespace fathom {

/// The seed of the registration of two frames: of these two and the base seed alone, so that no
/// registration depends on which others were tried, or in what order.
inline std::uint64_t pair_seed(std::uint64_t base_seed, std::size_t from, std::size_t to) {
  return stream_seed(stream_seed(base_seed, "registration", from), "with", to);
}

}  // namespace fathom

#pragma once

#include <cstddef>

namespace fathom::sparse {

/// An index as the standard containers want it.
constexpr std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

/// How many numbers a B × B block has.
template <int B>
inline constexpr std::size_t kBlockNumbers = at(B) * at(B);

}  // namespace fathom::sparse

#pragma once

#include <cstddef>

namespace fathom::sparse {

/// An index as the standard containers want it.
inline std::size_t at(int i) {
  return static_cast<std::size_t>(i);
}

}  // namespace fathom::sparse

#include "fathom/core/hash.hpp"

#include <cstring>

namespace fathom {

Hash& Hash::add(std::string_view bytes) {
  add_word(bytes.size());
  while (!bytes.empty()) {
    std::uint64_t word = 0;
    const std::string_view next = bytes.substr(0, sizeof word);
    std::memcpy(&word, next.data(), next.size());
    add_word(word);
    bytes.remove_prefix(next.size());
  }
  return *this;
}

}  // namespace fathom

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

std::string hash_text(const std::string& content) {
  std::uint64_t hash = 0xcbf29ce484222325ULL;
  for (const char letter : content) {
    hash = (hash ^ static_cast<unsigned char>(letter)) * 0x100000001b3ULL;
  }
  char buffer[17];
  std::snprintf(buffer, sizeof buffer, "%016llx", static_cast<unsigned long long>(hash));
  return buffer;
}

}  // namespace fathom

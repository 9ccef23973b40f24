#pragma once

#include <string>

namespace fathom {

/// So much of what a process prints is kept, in bytes; twice as much for a while.
inline constexpr std::size_t kKeptPrint = 2000;

/// Adds to what is kept of what a process printed.
inline void keep_print(const char* bytes, std::size_t count, std::string& kept) {
  kept.append(bytes, count);
  if (kept.size() > 2 * kKeptPrint) kept.erase(0, kept.size() - kKeptPrint);
}

/// The last three lines that were printed, on one line, in plain letters.
std::string last_lines_of(const std::string& printed);

}  // namespace fathom

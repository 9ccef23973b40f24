#pragma once

#include <chrono>
#include <cstddef>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

namespace fathom::test {

/// Every process whose command line has this word.
inline std::size_t processes_with(const std::string& word) {
  std::size_t count = 0;
  for (const auto& entry : std::filesystem::directory_iterator("/proc")) {
    std::ifstream in(entry.path() / "cmdline", std::ios::binary);
    const std::string line{std::istreambuf_iterator<char>(in), {}};
    // A process that is about to be reaped has no command line.
    if (line.find(word) != std::string::npos) ++count;
  }
  return count;
}

/// A process that was killed may take a while to go.
inline bool none_is_left(const std::string& word) {
  for (int look = 0; look < 1000; ++look) {
    if (processes_with(word) == 0) return true;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return false;
}

}  // namespace fathom::test

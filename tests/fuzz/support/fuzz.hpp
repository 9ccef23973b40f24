#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <unistd.h>

#include "fathom/core/input_error.hpp"

namespace fathom::fuzz {

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-reinterpret-cast): bytes as libFuzzer has them
  return {reinterpret_cast<const char*>(data), size};
}

/// What must hold whatever the input; else the input is a finding.
inline void require(bool holds, std::string_view what) {
  if (holds) return;
  std::fprintf(stderr, "broken: %.*s\n", static_cast<int>(what.size()), what.data());
  std::abort();
}

/// Does what may refuse an input, in one line; false where it did. All else that it throws is a
/// finding.
template <class Action>
bool is_taken(Action action) {
  try {
    action();
  } catch (const InputError& refusal) {
    const std::string_view line = refusal.what();
    require(!line.empty() && line.find('\n') == std::string_view::npos, "a refusal is one line");
    return false;
  }
  return true;
}

/// A folder of this process alone, in memory where the system has a place for that.
class Folder {
 public:
  explicit Folder(std::string_view name) {
    const std::filesystem::path memory = "/dev/shm";
    const bool has_memory = ::access(memory.c_str(), W_OK) == 0;
    path_ = (has_memory ? memory : std::filesystem::temp_directory_path()) /
            ("fathom-fuzz-" + std::string(name) + "-" + std::to_string(::getpid()));
    std::filesystem::create_directories(path_);
  }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  const std::filesystem::path& path() const { return path_; }

  /// A file of it with this content alone.
  std::filesystem::path write(const std::filesystem::path& name, std::string_view content) const {
    const std::filesystem::path file = path_ / name;
    std::ofstream(file, std::ios::binary) << content;
    return file;
  }

 private:
  std::filesystem::path path_;
};

/// Numbers drawn from an input; at its end zeros.
class Draws {
 public:
  Draws(const std::uint8_t* data, std::size_t size) : data_(data), size_(size) {}

  bool is_empty() const { return size_ == 0; }

  std::uint8_t byte() {
    if (size_ == 0) return 0;
    --size_;
    return *data_++;
  }
  /// 0 … count − 1.
  std::size_t below(std::size_t count) { return byte() % count; }
  /// Of 65 536 values from `least` to `most`.
  double between(double least, double most) {
    const int high = byte();
    return least + (most - least) * (256 * high + byte()) / 65535.0;
  }

 private:
  const std::uint8_t* data_;
  std::size_t size_;
};

/// A file that is there, with some of its bytes replaced: an input is a list of edits, each three
/// bytes of where, one of how many, and what.
inline std::string edited(std::string content, Draws edits) {
  while (!edits.is_empty() && !content.empty()) {
    std::size_t at = edits.byte();
    at = 65536 * edits.byte() + 256 * edits.byte() + at;
    at %= content.size();
    const std::size_t count = std::min(1 + edits.below(16), content.size() - at);
    for (std::size_t i = 0; i < count; ++i) content[at + i] = static_cast<char>(edits.byte());
  }
  return content;
}

}  // namespace fathom::fuzz

#include "file_names.hpp"

#include <algorithm>
#include <cstddef>

namespace fathom {
namespace {

constexpr std::size_t kLongest = 80;
constexpr std::size_t kRoomForNumber = 8;

bool is_plain(char letter) {
  return (letter >= 'a' && letter <= 'z') || (letter >= 'A' && letter <= 'Z') ||
         (letter >= '0' && letter <= '9') || letter == '.' || letter == '-';
}

char small(char letter) {
  return letter >= 'A' && letter <= 'Z' ? static_cast<char>(letter - 'A' + 'a') : letter;
}

std::string safe(std::string_view text) {
  std::string name;
  for (const char letter : text) {
    if (is_plain(letter)) {
      name += letter;
    } else if (!name.empty() && name.back() != '_') {
      name += '_';
    }
  }
  name.resize(std::min(name.size(), kLongest - kRoomForNumber));
  while (!name.empty() && name.back() == '_') name.pop_back();
  // Neither hidden nor read as an option.
  if (name.empty() || name.front() == '.' || name.front() == '-') name.insert(0, 1, '_');
  return name;
}

}  // namespace

std::string FileNames::unique(std::string_view text) {
  const std::string first = safe(text);
  std::string name = first;
  const auto is_taken = [this](std::string key) {
    std::transform(key.begin(), key.end(), key.begin(), small);
    return !taken_.insert(key).second;
  };
  for (std::size_t i = 2; is_taken(name); ++i) name = first + "-" + std::to_string(i);
  return name;
}

}  // namespace fathom

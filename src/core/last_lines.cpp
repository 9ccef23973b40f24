#include "last_lines.hpp"

namespace fathom {

std::string last_lines_of(const std::string& printed) {
  constexpr int kLastLines = 3;
  std::string text;
  std::size_t end = printed.find_last_not_of("\n\r \t");
  if (end == std::string::npos) return text;
  ++end;
  for (int line = 0; line < kLastLines && end > 0; ++line) {
    const std::size_t before = printed.find_last_of('\n', end - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const std::string one = printed.substr(begin, end - begin);
    text = text.empty() ? one : one + " | " + text;
    if (before == std::string::npos) break;
    end = before;
  }
  for (char& letter : text) {
    const auto code = static_cast<unsigned char>(letter);
    if (code < 0x20) letter = ' ';
    if (code > 0x7e) letter = '?';  // of what encoding it is nobody knows, nor where it was cut
  }
  return text;
}

}  // namespace fathom

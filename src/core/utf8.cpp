#include "utf8.hpp"

namespace fathom {
namespace {

constexpr const char* kReplacement = "\xEF\xBF\xBD";

// The least value that needs so many bytes: a longer form of a lower one is no UTF-8.
std::uint32_t least_of(std::size_t bytes) {
  return bytes == 4 ? 0x10000 : bytes == 3 ? 0x800 : 0x80;
}

bool is_character(std::uint32_t value) {
  return value <= 0x10FFFF && (value < 0xD800 || value > 0xDFFF);
}

}  // namespace

CodePoint first_code_point(std::string_view text) {
  const auto lead = static_cast<unsigned char>(text.front());
  if (lead < 0x80) return {lead, 1, true};
  const CodePoint invalid{lead, 1, false};
  const std::size_t length = lead >= 0xF0 ? 4 : lead >= 0xE0 ? 3 : lead >= 0xC0 ? 2 : 1;
  if (length == 1 || length > text.size() || lead >= 0xF8) return invalid;
  std::uint32_t value = lead & (0xFFU >> (length + 1));
  for (std::size_t i = 1; i < length; ++i) {
    const auto byte = static_cast<unsigned char>(text[i]);
    if ((byte & 0xC0) != 0x80) return invalid;
    value = (value << 6) | (byte & 0x3FU);
  }
  if (value < least_of(length) || !is_character(value)) return invalid;
  return {value, length, true};
}

std::string drawable_text(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const CodePoint point = first_code_point(text);
    if (!point.valid) {
      result += kReplacement;
    } else if (point.value < 0x20 || point.value == 0x7F) {
      result += ' ';
    } else {
      result += text.substr(0, point.bytes);
    }
    text.remove_prefix(point.bytes);
  }
  return result;
}

}  // namespace fathom

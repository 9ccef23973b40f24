#include "fathom/core/utf8.hpp"

#include <algorithm>
#include <array>
#include <cstdio>
#include <utility>

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

// First and last of what changes how the text about it is shown: Unicode's controls of direction,
// and its ends of lines.
constexpr std::array<std::pair<std::uint32_t, std::uint32_t>, 6> kTurning{{{0x061C, 0x061C},
                                                                           {0x200E, 0x200F},
                                                                           {0x2028, 0x202E},
                                                                           {0x2066, 0x2069},
                                                                           {0xFEFF, 0xFEFF},
                                                                           {0xFFF9, 0xFFFB}}};

bool is_shown_as_it_is(std::uint32_t value) {
  if (value == '\t') return true;
  if (value < 0x20 || (value >= 0x7F && value < 0xA0)) return false;
  return std::none_of(kTurning.begin(), kTurning.end(), [value](const auto& range) {
    return range.first <= value && value <= range.second;
  });
}

std::string written_out(const CodePoint& point) {
  char text[16];
  std::snprintf(text, sizeof text, point.valid ? "<U+%04X>" : "<0x%02X>", point.value);
  return text;
}

std::string shown(std::string_view text) {
  std::string result;
  while (!text.empty()) {
    const CodePoint point = first_code_point(text);
    if (point.valid && is_shown_as_it_is(point.value)) {
      result += text.substr(0, point.bytes);
    } else {
      result += written_out(point);
    }
    text.remove_prefix(point.bytes);
  }
  return result;
}

// The first byte of a character, from here on.
std::size_t begin_of_character(std::string_view text, std::size_t at) {
  while (at < text.size() && (static_cast<unsigned char>(text[at]) & 0xC0U) == 0x80) ++at;
  return at;
}

// What is wrong stands at the end of many a message, and what it is about at the beginning.
std::string printable_line(std::string_view line, std::size_t longest) {
  if (line.size() <= longest) return shown(line);
  const std::size_t head = begin_of_character(line, longest - longest / 4);
  const std::size_t tail = std::max(head, begin_of_character(line, line.size() - longest / 4));
  return shown(line.substr(0, head)) + "… (" + std::to_string(tail - head) + " bytes) …" +
         shown(line.substr(tail));
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

std::string printable(std::string_view text, std::size_t longest_line) {
  std::string lines;
  while (true) {
    const std::size_t end = text.find('\n');
    lines += printable_line(text.substr(0, end), longest_line);
    if (end == std::string_view::npos) return lines;
    lines += '\n';
    text.remove_prefix(end + 1);
  }
}

}  // namespace fathom

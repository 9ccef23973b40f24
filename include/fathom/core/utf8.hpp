#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

namespace fathom {

struct CodePoint {
  std::uint32_t value = 0;
  std::size_t bytes = 1;
  bool valid = true;
};

/// The first character of a text that is not empty. A byte that opens none stands for itself, as
/// one that is not valid.
CodePoint first_code_point(std::string_view text);

/// The text as one line that can be drawn: control characters as blanks, and what is no UTF-8 as
/// U+FFFD.
std::string drawable_text(std::string_view text);

/// Text that holds what others wrote, as it may stand on a terminal. Control characters but line
/// feed and tab, those that turn the direction of writing, and bytes that are no UTF-8 are written
/// out, `<U+202E>` and `<0x9B>`; of a line of more bytes than this the middle is counted.
std::string printable(std::string_view text, std::size_t longest_line = 4000);

}  // namespace fathom

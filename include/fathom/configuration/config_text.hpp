#pragma once

#include <string>
#include <vector>

namespace fathom {

/// A key of a configuration to be written.
struct ConfigLine {
  std::string key;       ///< dotted
  std::string value;     ///< a word, or a list in brackets
  bool is_list = false;  ///< else a value in brackets is a word
  std::string comment;   ///< at the end of the line; may be empty
};

/// Nested YAML as one would write it: a map for the first part of the keys, one line for each
/// second part, and what is below in braces where that is no long line. A line with a comment has
/// its dotted key. Read back, every value is the same word for word. Throws InputError for one that
/// is not UTF-8 and needs quotes.
std::string config_text(const std::vector<ConfigLine>& lines);

}  // namespace fathom

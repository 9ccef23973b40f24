#pragma once

#include <string>
#include <vector>

namespace fathom {

/// A key of a configuration to be written, its value as YAML.
struct ConfigLine {
  std::string key;      ///< dotted
  std::string value;    ///< as YAML; empty: the comment stands alone
  std::string comment;  ///< at the end of the line; may be empty
};

/// A value as YAML reads it back, word for word. A list in brackets stays as it is.
std::string yaml_value(const std::string& value, bool is_list);

/// Nested YAML as one would write it: a map for the first part of the keys, one line for each
/// second part, and what is below in braces. A line with a comment has its dotted key.
std::string config_text(const std::vector<ConfigLine>& lines);

}  // namespace fathom

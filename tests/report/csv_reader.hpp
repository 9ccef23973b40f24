#pragma once

#include <map>
#include <string>
#include <vector>

namespace fathom::test {

/// Rows of a CSV file after RFC 4180, by the names of its header. A std::runtime_error where a row
/// has more or fewer fields than the header.
std::vector<std::map<std::string, std::string>> read_csv(const std::string& text);

}  // namespace fathom::test

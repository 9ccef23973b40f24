#pragma once

#include <set>
#include <string>
#include <string_view>

namespace fathom {

/// Names of files made from titles and labels, which may hold anything: letters, digits, `.` and
/// `-` of ASCII with `_` for all else, at most 80 bytes, no two the same even where a file system
/// does not tell capitals.
class FileNames {
 public:
  /// "nees_separation_5"; "-2" is added to a name that is taken.
  std::string unique(std::string_view text);

 private:
  std::set<std::string> taken_;  ///< in small letters
};

}  // namespace fathom

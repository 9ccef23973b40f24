#pragma once

#include <string>
#include <vector>

namespace fathom {

/// A key without effect, and the key whose value takes it away. A configuration that gives it is
/// refused: it would go unread.
struct IgnoredKey {
  std::string key;
  std::string chooser;
};

/// The ignored keys of a group, with the group's name and a dot in front.
inline std::vector<IgnoredKey> below(const std::string& group, std::vector<IgnoredKey> ignored) {
  for (IgnoredKey& one : ignored) {
    one.key.insert(0, group + ".");
    one.chooser.insert(0, group + ".");
  }
  return ignored;
}

}  // namespace fathom

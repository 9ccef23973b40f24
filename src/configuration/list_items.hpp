#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "fathom/core/text.hpp"

namespace fathom {

/// Whether a key is below one of the first `count` items of a list: "sweep.1.key" is below item 1
/// of "sweep.".
inline bool is_item_below(std::string_view key, std::string_view list, std::size_t count) {
  if (!key.starts_with(list)) return false;
  key.remove_prefix(list.size());
  const std::string_view item = key.substr(0, key.find('.'));
  const auto number = parse_integer(item);
  return item.size() < key.size() && number && *number >= 0 &&
         static_cast<std::size_t>(*number) < count && std::to_string(*number) == item;
}

}  // namespace fathom

#pragma once

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

namespace fathom {

/// With 6 digits; null where it is not finite.
nlohmann::ordered_json page_number(double value);

inline nlohmann::ordered_json page_number(const std::optional<double>& value) {
  return value ? page_number(*value) : nlohmann::ordered_json();
}

template <typename Value>
nlohmann::ordered_json page_numbers(const std::vector<Value>& values) {
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (const Value& value : values) list.push_back(page_number(value));
  return list;
}

}  // namespace fathom

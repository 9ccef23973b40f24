#pragma once

#include <optional>
#include <vector>

#include <nlohmann/json.hpp>

namespace fathom {

/// With 6 digits, of what is drawn; null where it is not finite.
nlohmann::ordered_json page_number(double value);

/// With all digits, of what is printed: it is rounded once, as in tables.
nlohmann::ordered_json page_value(double value);

inline nlohmann::ordered_json page_value(const std::optional<double>& value) {
  return value ? page_value(*value) : nlohmann::ordered_json();
}

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

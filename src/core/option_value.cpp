#include "option_value.hpp"

#include <limits>
#include <optional>

#include "fathom/core/input_error.hpp"
#include "fathom/core/text.hpp"

namespace fathom {

std::string OptionValue::text() const {
  return is_list ? "[" + joined(items, ", ") + "]" : joined(items, ", ");
}

std::string list_text(const std::vector<double>& values) {
  std::vector<std::string> words;
  words.reserve(values.size());
  for (const double value : values) words.push_back(number_text(value));
  return "[" + joined(words, ", ") + "]";
}

void refuse(const std::string& key, const std::string& expected, const OptionValue& value) {
  throw InputError(key + ": expected " + expected + ", got " + in_quotes(value.text()));
}

bool is_word(const OptionValue& value, const std::string& word) {
  return !value.is_list && value.items.size() == 1 && value.items.front() == word;
}

double checked_real(const OptionDescription& option, const Range& range, const OptionValue& value,
                    const std::string& alternative) {
  const auto number =
      value.is_list || value.items.size() != 1 ? std::nullopt : parse_real(value.items.front());
  if (number && range.contains(*number)) return *number;
  const std::string bounds = range.text();
  refuse(option.key,
         "a number" + (option.unit.empty() ? "" : " in " + option.unit) +
             (bounds.empty() ? "" : " " + bounds) + alternative,
         value);
}

int checked_integer(const OptionDescription& option, const Range& range, const OptionValue& value,
                    const std::string& alternative) {
  const auto number =
      value.is_list || value.items.size() != 1 ? std::nullopt : parse_integer(value.items.front());
  if (!number || !range.contains(static_cast<double>(*number)) ||
      *number > std::numeric_limits<int>::max() || *number < std::numeric_limits<int>::min()) {
    const std::string bounds = range.text();
    refuse(option.key, "a whole number" + (bounds.empty() ? "" : " " + bounds) + alternative,
           value);
  }
  return static_cast<int>(*number);
}

}  // namespace fathom

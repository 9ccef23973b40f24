#include "fathom/core/options.hpp"

#include <algorithm>
#include <memory>

#include "fathom/core/text.hpp"
#include "option_value.hpp"

namespace fathom {
namespace {

// As one would write it: 1e6 and not 1e+06.
std::string bound_text(double bound) {
  std::string text = number_text(bound);
  const std::size_t exponent = text.find('e');
  if (exponent == std::string::npos) return text;
  std::size_t digit = exponent + 1;
  if (text[digit] == '+') text.erase(digit, 1);
  if (text[digit] == '-') ++digit;
  while (digit + 1 < text.size() && text[digit] == '0') text.erase(digit, 1);
  return text;
}

}  // namespace

bool Range::contains(double value) const {
  return (minimum_excluded ? value > minimum : value >= minimum) && value <= maximum;
}

std::string Range::text() const {
  std::vector<std::string> bounds;
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  if (minimum > -kInfinity)
    bounds.push_back((minimum_excluded ? "> " : ">= ") + bound_text(minimum));
  if (maximum < kInfinity) bounds.push_back("<= " + bound_text(maximum));
  return joined(bounds, ", ");
}

std::string suggestion(const std::string& word, const std::vector<std::string>& among) {
  const auto near = nearest(word, among);
  return near ? "; did you mean '" + *near + "'?" : "";
}

std::string OptionTable::add(const std::string& key, OptionDescription description, Setter setter,
                             Getter getter) {
  description.key = prefix_ + key;
  description.default_value = getter();
  descriptions_.push_back(std::move(description));
  setters_.push_back(std::move(setter));
  getters_.push_back(std::move(getter));
  return descriptions_.back().key;
}

void OptionTable::boolean(const std::string& key, bool& field, const std::string& help) {
  const std::string full = prefix_ + key;
  add(
      key, {"", "boolean", "", "", "true or false", help},
      [&field, full](const OptionValue& value) {
        const std::string given = value.items.size() == 1 ? value.items.front() : "";
        if (value.is_list || (given != "true" && given != "false")) {
          refuse(full, "true or false", value);
        }
        field = given == "true";
      },
      [&field] { return std::string(field ? "true" : "false"); });
}

void OptionTable::integer(const std::string& key, int& field, Range range, const std::string& unit,
                          const std::string& help) {
  const std::string full = prefix_ + key;
  add(
      key, {"", "integer", unit, "", range.text(), help},
      [&field, full, range](const OptionValue& value) {
        field = checked_integer(full, range, value);
      },
      [&field] { return std::to_string(field); });
}

void OptionTable::integer_or_off(const std::string& key, std::optional<int>& field, Range range,
                                 const std::string& unit, const std::string& help) {
  const std::string full = prefix_ + key;
  add(
      key, {"", "integer or off", unit, "", range.text() + " or off", help},
      [&field, full, range](const OptionValue& value) {
        if (!value.is_list && value.items.size() == 1 && value.items.front() == "off") {
          field.reset();
        } else {
          field = checked_integer(full, range, value, " or off");
        }
      },
      [&field] { return field ? std::to_string(*field) : std::string("off"); });
}

void OptionTable::real(const std::string& key, double& field, Range range, const std::string& unit,
                       const std::string& help) {
  const std::string full = prefix_ + key;
  add(
      key, {"", "real", unit, "", range.text(), help},
      [&field, full, range, unit](const OptionValue& value) {
        field = checked_real(full, range, unit, value);
      },
      [&field] { return number_text(field); });
}

void OptionTable::real_or(const std::string& key, const std::string& word,
                          std::optional<double>& field, Range range, const std::string& unit,
                          const std::string& help) {
  const std::string full = prefix_ + key;
  add(
      key, {"", "real or " + word, unit, "", range.text() + " or " + word, help},
      [&field, full, word, range, unit](const OptionValue& value) {
        if (!value.is_list && value.items.size() == 1 && value.items.front() == word) {
          field.reset();
        } else {
          field = checked_real(full, range, unit, value, " or " + word);
        }
      },
      [&field, word] { return field ? number_text(*field) : word; });
}

void OptionTable::text(const std::string& key, std::string& field, const std::string& help) {
  const std::string full = prefix_ + key;
  add(
      key, {"", "text", "", "", "", help},
      [&field, full](const OptionValue& value) {
        if (value.is_list || value.items.size() != 1) refuse(full, "a text", value);
        field = value.items.front();
      },
      [&field] { return field; });
}

void OptionTable::choice(const std::string& key, std::string& field,
                         const std::vector<std::string>& choices, const std::string& help) {
  add_choice(key, field, choices, help, [&field](const std::string& given) { field = given; });
}

void OptionTable::add_choice(const std::string& key, const std::string& current,
                             const std::vector<std::string>& choices, const std::string& help,
                             std::function<void(const std::string&)> assign) {
  const std::string full = prefix_ + key;
  auto present = std::make_shared<std::string>(current);
  add(
      key, {"", "text", "", "", joined(choices, " | "), help},
      [full, choices, present, assign = std::move(assign)](const OptionValue& value) {
        for (const std::string& name : choices) {
          if (!value.is_list && value.items.size() == 1 && value.items.front() == name) {
            *present = name;
            assign(name);
            return;
          }
        }
        throw InputError(full + ": expected one of " + joined(choices, ", ") + ", got " +
                         in_quotes(value.text()) + suggestion(value.text(), choices));
      },
      [present] { return *present; });
}

void OptionTable::reals(const std::string& key, std::vector<double>& field, std::size_t multiple_of,
                        const std::string& unit, const std::string& help) {
  const std::string full = prefix_ + key;
  const std::string length =
      multiple_of > 1 ? "a multiple of " + std::to_string(multiple_of) + " numbers" : "";
  add(
      key, {"", "list of real", unit, "", length, help},
      [&field, full, multiple_of, length](const OptionValue& value) {
        std::vector<double> numbers;
        for (const std::string& item : value.items) {
          const auto number = parse_real(item);
          if (!number) refuse(full, "a list of numbers", value);
          numbers.push_back(*number);
        }
        if (!value.is_list || numbers.size() % multiple_of != 0) {
          refuse(full, "a list of " + (length.empty() ? std::string("numbers") : length), value);
        }
        field = std::move(numbers);
      },
      [&field] { return list_text(field); });
}

void OptionTable::words(const std::string& key, std::vector<std::string>& field,
                        const std::string& help) {
  const std::string full = prefix_ + key;
  add(
      key, {"", "list of words", "", "", "", help},
      [&field, full](const OptionValue& value) {
        if (!value.is_list) refuse(full, "a list of words", value);
        field = value.items;
      },
      [&field] { return "[" + joined(field, ", ") + "]"; });
}

std::vector<std::string> OptionTable::keys() const {
  std::vector<std::string> names;
  for (const OptionDescription& description : descriptions_) names.push_back(description.key);
  return names;
}

std::size_t OptionTable::index_of(const std::string& key) const {
  for (std::size_t i = 0; i < descriptions_.size(); ++i) {
    if (descriptions_[i].key == key) return i;
  }
  throw InputError("unknown key '" + key + "'" + suggestion(key, keys()));
}

bool OptionTable::has(const std::string& key) const {
  return std::any_of(descriptions_.begin(), descriptions_.end(),
                     [&](const OptionDescription& description) { return description.key == key; });
}

void OptionTable::set(const std::string& key, const OptionValue& value) {
  setters_[index_of(key)](value);
}

std::string OptionTable::value(const std::string& key) const {
  return getters_[index_of(key)]();
}

}  // namespace fathom

#include "fathom/core/options.hpp"

#include <algorithm>
#include <memory>
#include <utility>

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
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  std::string text;
  if (minimum > -kInfinity) text = (minimum_excluded ? "> " : ">= ") + bound_text(minimum);
  if (maximum < kInfinity) text += (text.empty() ? "<= " : ", <= ") + bound_text(maximum);
  return text;
}

std::string suggestion(const std::string& word, const std::vector<std::string>& among) {
  const std::vector<std::string> near = nearest(word, among);
  return near.empty() ? "" : "; did you mean '" + joined(near, "' or '") + "'?";
}

std::string not_one_of(const std::string& word, const std::vector<std::string>& choices) {
  return "expected one of " + joined(choices, ", ") + ", got " + in_quotes(word) +
         suggestion(word, choices);
}

void OptionTable::add(const std::string& key, OptionDescription description, Setter setter,
                      Getter getter) {
  description.key = prefix_ + key;
  description.default_value = getter();
  descriptions_.push_back(std::move(description));
  setters_.push_back(std::move(setter));
  getters_.push_back(std::move(getter));
}

void OptionTable::boolean(const std::string& key, bool& field, std::string help) {
  add(
      key, {"", "boolean", "", "", "true or false", std::move(help)},
      [&field](const OptionDescription& option, const OptionValue& value) {
        const std::string given = value.items.size() == 1 ? value.items.front() : "";
        if (value.is_list || (given != "true" && given != "false")) {
          refuse(option.key, option.range, value);
        }
        field = given == "true";
      },
      [&field] { return std::string(field ? "true" : "false"); });
}

void OptionTable::integer(const std::string& key, int& field, Range range, std::string unit,
                          std::string help) {
  add(
      key, {"", "integer", std::move(unit), "", range.text(), std::move(help)},
      [&field, range](const OptionDescription& option, const OptionValue& value) {
        field = checked_integer(option, range, value);
      },
      [&field] { return std::to_string(field); });
}

void OptionTable::integer_or_off(const std::string& key, std::optional<int>& field, Range range,
                                 std::string unit, std::string help) {
  add(
      key, {"", "integer or off", std::move(unit), "", range.text() + " or off", std::move(help)},
      [&field, range](const OptionDescription& option, const OptionValue& value) {
        if (is_word(value, "off")) {
          field.reset();
        } else {
          field = checked_integer(option, range, value, " or off");
        }
      },
      [&field] { return field ? std::to_string(*field) : std::string("off"); });
}

void OptionTable::real(const std::string& key, double& field, Range range, std::string unit,
                       std::string help) {
  add(
      key, {"", "real", std::move(unit), "", range.text(), std::move(help)},
      [&field, range](const OptionDescription& option, const OptionValue& value) {
        field = checked_real(option, range, value);
      },
      [&field] { return number_text(field); });
}

void OptionTable::real_or(const std::string& key, const std::string& word,
                          std::optional<double>& field, Range range, std::string unit,
                          std::string help) {
  add(
      key,
      {"", "real or " + word, std::move(unit), "", range.text() + " or " + word, std::move(help)},
      [&field, word, range](const OptionDescription& option, const OptionValue& value) {
        if (is_word(value, word)) {
          field.reset();
        } else {
          field = checked_real(option, range, value, " or " + word);
        }
      },
      [&field, word] { return field ? number_text(*field) : word; });
}

void OptionTable::text(const std::string& key, std::string& field, std::string help) {
  add(
      key, {"", "text", "", "", "", std::move(help)},
      [&field](const OptionDescription& option, const OptionValue& value) {
        if (value.is_list || value.items.size() != 1) refuse(option.key, "a text", value);
        field = value.items.front();
      },
      [&field] { return field; });
}

void OptionTable::choice(const std::string& key, std::string& field,
                         std::vector<std::string> choices, std::string help) {
  add_choice(key, field, std::move(choices), std::move(help),
             [&field](std::size_t /*place*/, const std::string& given) { field = given; });
}

void OptionTable::add_choice(const std::string& key, std::string current,
                             std::vector<std::string> choices, std::string help,
                             std::function<void(std::size_t, const std::string&)> assign) {
  auto present = std::make_shared<std::string>(std::move(current));
  std::string range = joined(choices, " | ");
  add(
      key, {"", "text", "", "", std::move(range), std::move(help)},
      [choices = std::move(choices), present, assign = std::move(assign)](
          const OptionDescription& option, const OptionValue& value) {
        for (std::size_t place = 0; place < choices.size(); ++place) {
          if (!is_word(value, choices[place])) continue;
          *present = choices[place];
          assign(place, choices[place]);
          return;
        }
        throw InputError(option.key + ": " + not_one_of(value.text(), choices));
      },
      [present] { return *present; });
}

void OptionTable::reals(const std::string& key, std::vector<double>& field, std::size_t multiple_of,
                        std::string unit, std::string help) {
  std::string length =
      multiple_of > 1 ? "a multiple of " + std::to_string(multiple_of) + " numbers" : "";
  add(
      key, {"", "list of real", std::move(unit), "", std::move(length), std::move(help)},
      [&field, multiple_of](const OptionDescription& option, const OptionValue& value) {
        std::vector<double> numbers;
        for (const std::string& item : value.items) {
          const auto number = parse_real(item);
          if (!number) refuse(option.key, "a list of numbers", value);
          numbers.push_back(*number);
        }
        if (!value.is_list || numbers.size() % multiple_of != 0) {
          refuse(option.key, "a list of " + (option.range.empty() ? "numbers" : option.range),
                 value);
        }
        field = std::move(numbers);
      },
      [&field] { return list_text(field); });
}

void OptionTable::words(const std::string& key, std::vector<std::string>& field, std::string help) {
  add(
      key, {"", "list of words", "", "", "", std::move(help)},
      [&field](const OptionDescription& option, const OptionValue& value) {
        if (!value.is_list) refuse(option.key, "a list of words", value);
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
  const std::size_t place = index_of(key);
  setters_[place](descriptions_[place], value);
}

std::string OptionTable::value(const std::string& key) const {
  return value_at(index_of(key));
}

}  // namespace fathom

#pragma once

#include <functional>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fathom/core/input_error.hpp"

namespace fathom {

/// Bounds of a number, both included unless said.
struct Range {
  double minimum = -std::numeric_limits<double>::infinity();
  double maximum = std::numeric_limits<double>::infinity();
  bool minimum_excluded = false;

  static Range any() { return {}; }
  static Range at_least(double bound) { return {bound}; }
  static Range positive() { return {0.0, std::numeric_limits<double>::infinity(), true}; }
  static Range between(double low, double high) { return {low, high}; }

  bool contains(double value) const;
  std::string text() const;
};

/// What is known of one option: the only place where its name, unit, default and bounds stand.
/// Help, validation and documentation are made from it.
struct OptionDescription {
  std::string key;            ///< dotted, for example "ransac.max_error_m"
  std::string type;           ///< "integer", "real", "boolean", "text", "list of real"
  std::string unit;           ///< "m", "rad", "frames"; empty for a pure number
  std::string default_value;  ///< as one would write it in a config
  std::string range;          ///< bounds or choices, in words
  std::string help;           ///< one line
};

/// A value as a config gives it: one scalar, or a list of them.
struct OptionValue {
  std::vector<std::string> items;
  bool is_list = false;

  static OptionValue scalar(std::string text) { return {{std::move(text)}, false}; }

  /// As a config has it, a list as "[a, b]".
  std::string text() const;
};

/// Binds the fields of option structs to described keys. Every option struct has a member
/// `void describe(OptionTable&)`; the default of an option is the initialiser of its field.
/// The table refers to the fields: it must not outlive them.
class OptionTable {
 public:
  void boolean(const std::string& key, bool& field, std::string help);
  void integer(const std::string& key, int& field, Range range, std::string unit, std::string help);
  /// A whole number or the word `off`.
  void integer_or_off(const std::string& key, std::optional<int>& field, Range range,
                      std::string unit, std::string help);
  void real(const std::string& key, double& field, Range range, std::string unit, std::string help);
  /// A number or the word `off`.
  void real_or_off(const std::string& key, std::optional<double>& field, Range range,
                   std::string unit, std::string help) {
    real_or(key, "off", field, range, std::move(unit), std::move(help));
  }
  /// A number or the word, which leaves the field empty.
  void real_or(const std::string& key, const std::string& word, std::optional<double>& field,
               Range range, std::string unit, std::string help);
  void text(const std::string& key, std::string& field, std::string help);
  void choice(const std::string& key, std::string& field, std::vector<std::string> choices,
              std::string help);
  /// A list of numbers, `[a, b, c]`; nested lists are read as one.
  void reals(const std::string& key, std::vector<double>& field, std::size_t multiple_of,
             std::string unit, std::string help);

  /// A list of words, `[a, b]`.
  void words(const std::string& key, std::vector<std::string>& field, std::string help);

  template <class Enum>
  void enumeration(const std::string& key, Enum& field,
                   const std::vector<std::pair<std::string, Enum>>& names,
                   const std::string& help) {
    std::vector<std::string> choices;
    std::vector<Enum> values;
    std::string current;
    for (const auto& [name, value] : names) {
      choices.push_back(name);
      values.push_back(value);
      if (value == field) current = name;
    }
    add_choice(key, std::move(current), std::move(choices), help,
               [&field, values = std::move(values)](std::size_t place, const std::string&) {
                 field = values[place];
               });
  }

  /// The options of a part, under `name.`.
  template <class Options>
  void group(const std::string& name, Options& options) {
    const std::string outer = prefix_;
    prefix_ += name + ".";
    options.describe(*this);
    prefix_ = outer;
  }

  /// Sets the field behind a key. Throws InputError with the key, what was given and what would be
  /// right; an unknown key names the nearest known one.
  void set(const std::string& key, const OptionValue& value);

  const std::vector<OptionDescription>& descriptions() const { return descriptions_; }
  std::vector<std::string> keys() const;
  bool has(const std::string& key) const;
  /// The field's present value, as text. Throws InputError on an unknown key.
  std::string value(const std::string& key) const;
  /// The same by its place in descriptions().
  std::string value_at(std::size_t place) const { return getters_[place](); }

 private:
  // Given the option's own description, so that none keeps a copy of it.
  using Setter = std::function<void(const OptionDescription&, const OptionValue&)>;
  using Getter = std::function<std::string()>;

  void add(const std::string& key, OptionDescription description, Setter setter, Getter getter);
  /// `assign` is given the place of the choice and its word.
  void add_choice(const std::string& key, std::string current, std::vector<std::string> choices,
                  std::string help, std::function<void(std::size_t, const std::string&)> assign);
  std::size_t index_of(const std::string& key) const;

  std::string prefix_;
  std::vector<OptionDescription> descriptions_;
  std::vector<Setter> setters_;
  std::vector<Getter> getters_;
};

/// "; did you mean 'x'?", of several that are as near "'x' or 'y'", or nothing.
std::string suggestion(const std::string& word, const std::vector<std::string>& among);

/// "expected one of x, y, got 'z'", and a suggestion.
std::string not_one_of(const std::string& word, const std::vector<std::string>& choices);

}  // namespace fathom

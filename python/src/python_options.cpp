#include "python/src/python_options.hpp"

#include <limits>
#include <pybind11/stl.h>
#include <type_traits>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

namespace py = pybind11;

void describe(PythonOption& option, OptionTable& table) {
  const auto add = [&](auto& value) {
    using Value = std::decay_t<decltype(value)>;
    const std::string& key = option.key;
    if constexpr (std::is_same_v<Value, bool>) {
      table.boolean(key, value, option.help);
    } else if constexpr (std::is_same_v<Value, int>) {
      table.integer(key, value, option.range, option.unit, option.help);
    } else if constexpr (std::is_same_v<Value, double>) {
      table.real(key, value, option.range, option.unit, option.help);
    } else if constexpr (std::is_same_v<Value, std::optional<double>>) {
      table.real_or_off(key, value, option.range, option.unit, option.help);
    } else if constexpr (std::is_same_v<Value, std::vector<double>>) {
      table.reals(key, value, 1, option.unit, option.help);
    } else if (option.choices.empty()) {
      table.text(key, value, option.help);
    } else {
      table.choice(key, value, option.choices, option.help);
    }
  };
  std::visit(add, option.value);
}

void describe(PythonOptions& options, OptionTable& table) {
  for (PythonOption& option : options) describe(option, table);
}

void set_default(PythonOption& option, const py::handle& value) {
  if (value.is_none()) {
    option.value = std::optional<double>();
  } else if (py::isinstance<py::bool_>(value)) {
    option.value = value.cast<bool>();
  } else if (py::isinstance<py::int_>(value)) {
    option.value = value.cast<int>();
  } else if (py::isinstance<py::float_>(value)) {
    option.value = value.cast<double>();
  } else if (py::isinstance<py::str>(value)) {
    option.value = value.cast<std::string>();
  } else if (py::isinstance<py::list>(value) || py::isinstance<py::tuple>(value)) {
    option.value = value.cast<std::vector<double>>();
  } else {
    throw InputError("option '" + option.key +
                     "': the default is no bool, int, float, str, list of floats or None");
  }
}

// A limit that its type does not have would not be held.
void require_limits_to_fit(const PythonOption& option) {
  const bool is_text = std::holds_alternative<std::string>(option.value);
  const bool is_number = std::holds_alternative<int>(option.value) ||
                         std::holds_alternative<double>(option.value) ||
                         std::holds_alternative<std::optional<double>>(option.value);
  if (!is_number && option.range.text() != Range::any().text()) {
    throw InputError("option '" + option.key + "': at_least and at_most are of numbers");
  }
  if (!is_text && !option.choices.empty()) {
    throw InputError("option '" + option.key + "': choices are of text");
  }
}

double bound(const py::handle& option, const char* name, double none) {
  const py::object value = option.attr(name);
  return value.is_none() ? none : value.cast<double>();
}

}  // namespace

PythonOptions options_of(const py::handle& options) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  PythonOptions all;
  for (const auto& [key, given] : py::reinterpret_borrow<py::dict>(options)) {
    PythonOption option;
    const char* field = "name";
    try {
      option.key = key.cast<std::string>();
      option.help = given.attr(field = "help").cast<std::string>();
      option.unit = given.attr(field = "unit").cast<std::string>();
      const double low = bound(given, field = "at_least", -kInfinity);
      const double high = bound(given, field = "at_most", kInfinity);
      option.range = Range::between(low, high);
      option.choices = given.attr(field = "choices").cast<std::vector<std::string>>();
      set_default(option, given.attr(field = "default"));
    } catch (const py::cast_error&) {
      throw InputError("option " + py::repr(key).cast<std::string>() + ": " + field +
                       ": is of another type than that of fathom.Option, or too large");
    }
    require_limits_to_fit(option);
    all.push_back(std::move(option));
  }
  EstimatorValues values;
  for (const OptionDescription& one : descriptions_of(all)) {
    const bool is_list = one.default_value.starts_with("[");
    if (!is_list) values[one.key] = OptionValue::scalar(one.default_value);
  }
  with_values(all, values);
  return all;
}

std::vector<OptionDescription> descriptions_of(PythonOptions options) {
  OptionTable table;
  describe(options, table);
  return table.descriptions();
}

PythonOptions with_values(PythonOptions options, const EstimatorValues& values) {
  OptionTable table;
  describe(options, table);
  for (const auto& [key, value] : values) table.set(key, value);
  return options;
}

py::dict keywords_of(const PythonOptions& options) {
  py::dict keywords;
  for (const PythonOption& option : options) {
    std::visit([&](const auto& value) { keywords[option.key.c_str()] = py::cast(value); },
               option.value);
  }
  return keywords;
}

}  // namespace fathom

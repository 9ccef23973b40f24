#pragma once

#include <optional>
#include <pybind11/pybind11.h>
#include <string>
#include <variant>
#include <vector>

#include "fathom/estimation/registry.hpp"

namespace fathom {

/// An option of an estimator in Python; its value has the type of its default. None: a number that
/// is off.
struct PythonOption {
  std::string key;
  std::string help;
  std::string unit;
  Range range;
  std::vector<std::string> choices;
  std::variant<bool, int, double, std::string, std::vector<double>, std::optional<double>> value;
};

using PythonOptions = std::vector<PythonOption>;

/// Of a dict of fathom.Option by name. Throws InputError on a default of no such type, or outside
/// of its own bounds.
PythonOptions options_of(const pybind11::handle& options);

std::vector<OptionDescription> descriptions_of(PythonOptions options);

/// With these in place of the defaults. Throws InputError.
PythonOptions with_values(PythonOptions options, const EstimatorValues& values);

/// As keyword arguments.
pybind11::dict keywords_of(const PythonOptions& options);

}  // namespace fathom

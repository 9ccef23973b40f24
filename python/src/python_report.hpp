#pragma once

#include <pybind11/pybind11.h>

#include "fathom/estimation/estimator.hpp"

namespace fathom {

/// What an estimator in Python returned of an update: None, all is used, or its UpdateReport.
/// Throws InputError where that does not fit the measurements.
UpdateReport report_of(const pybind11::object& given, const Measurements& measurements);

/// The same of a solve, which decides on all measurements of the log at once: without decisions.
UpdateReport report_of_solve(const pybind11::object& given);

}  // namespace fathom

#pragma once

#include <pybind11/pybind11.h>

namespace fathom {

/// Each adds what it is named after to the module.
void bind_logs(pybind11::module_& module);
void bind_solve(pybind11::module_& module);

}  // namespace fathom

#pragma once

#include <pybind11/pybind11.h>

namespace fathom {

/// Each adds what it is named after to the module.
void bind_settings(pybind11::module_& module);
void bind_names(pybind11::module_& module);
void bind_measurements(pybind11::module_& module);
void bind_logs(pybind11::module_& module);
void bind_estimators(pybind11::module_& module);
void bind_solution(pybind11::module_& module);
void bind_solve(pybind11::module_& module);
void bind_run(pybind11::module_& module);
void bind_compare(pybind11::module_& module);
void bind_store(pybind11::module_& module);
void bind_registration(pybind11::module_& module);
void bind_evaluation(pybind11::module_& module);

}  // namespace fathom

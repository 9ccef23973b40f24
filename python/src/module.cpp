#include "fathom/core/input_error.hpp"
#include "fathom/core/version.hpp"
#include "python/src/bindings.hpp"

PYBIND11_MODULE(_fathom, module) {
  module.doc() = "Fathom's library; use the package fathom";
  module.attr("version") = fathom::version();
  pybind11::register_exception<fathom::InputError>(module, "InputError", PyExc_ValueError);
  for (const auto bind :
       {fathom::bind_settings, fathom::bind_names, fathom::bind_measurements, fathom::bind_logs,
        fathom::bind_estimators, fathom::bind_solution, fathom::bind_solve, fathom::bind_store,
        fathom::bind_run, fathom::bind_compare, fathom::bind_registration,
        fathom::bind_evaluation}) {
    bind(module);
  }
}

#include "fathom/core/input_error.hpp"
#include "python/src/bindings.hpp"

PYBIND11_MODULE(_fathom, module) {
  module.doc() = "Fathom's library; use the package fathom";
  pybind11::register_exception<fathom::InputError>(module, "InputError", PyExc_ValueError);
  fathom::bind_logs(module);
  fathom::bind_solve(module);
}

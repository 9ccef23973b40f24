#pragma once

#include <pybind11/pybind11.h>

#include "fathom/estimation/registry.hpp"

namespace fathom {

/// The entry of a subclass of fathom.Estimator: its options, its code's hashes, its objects. May be
/// copied, called and destroyed without the interpreter's lock; made with it. Throws InputError.
EstimatorEntry entry_of(const pybind11::handle& estimator_class);

/// What a Python exception says, on one line, with the file and line that raised it. Throws
/// std::bad_alloc of a MemoryError, and asks for the interrupt again of a KeyboardInterrupt.
std::string text_of(const pybind11::error_already_set& error);

/// A child that is forked from now on can run Python, whichever thread forks.
void make_forks_safe();

}  // namespace fathom

#pragma once

#include <string>

#include "fathom/core/input_error.hpp"

namespace fathom {

/// A fault of what the program runs in: a disk without room, a folder that is gone or may not be
/// written, no process, file or memory left. A command ends by it with one line, as by any bad
/// input. It passes through whatever watches an estimator: it is no run's result.
class EnvironmentError : public InputError {
 public:
  using InputError::InputError;

  /// `FILE: what: why`, where `error` is the errno of the system call that failed.
  EnvironmentError(const std::string& file, const std::string& what, int error);
};

/// Whether an errno is of the machine and of what it lends to this process, whatever was asked for:
/// no room, no descriptor, no memory, a disk that fails or may only be read.
bool is_fault_of_environment(int error);

}  // namespace fathom

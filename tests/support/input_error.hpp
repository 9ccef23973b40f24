#pragma once

#include <functional>
#include <string>

#include "fathom/core/input_error.hpp"

namespace fathom::test {

/// The message of the InputError that f throws; "(nothing thrown)" where it throws none. Any other
/// exception goes on and fails the test.
inline std::string input_error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& error) {
    return error.what();
  }
  return "(nothing thrown)";
}

}  // namespace fathom::test

#include "fathom/core/environment_error.hpp"

#include <cerrno>
#include <cstring>

namespace fathom {

EnvironmentError::EnvironmentError(const std::string& file, const std::string& what, int error)
    : InputError(file, what + ": " + std::strerror(error)) {}

bool is_fault_of_environment(int error) {
  switch (error) {
    case ENOSPC:
    case EDQUOT:
    case EROFS:
    case EIO:
    case EMFILE:
    case ENFILE:
    case ENOMEM:
    case EAGAIN:
      return true;
    default:
      return false;
  }
}

}  // namespace fathom

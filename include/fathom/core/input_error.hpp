#pragma once

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace fathom {

/// The one exception of the library: what the user gave cannot be used. The message is one line
/// that says what is wrong and what would be right, opening with `FILE:LINE:` where there is one;
/// ends of lines in it, of a name or of what another library says of a file, become blanks.
/// Numerical failure is no bad input: it is returned as an Outcome.
class InputError : public std::runtime_error {
 public:
  explicit InputError(const std::string& message) : std::runtime_error(in_one_line(message)) {}

  InputError(const std::string& file, std::size_t line, const std::string& message)
      : InputError(file + ":" + std::to_string(line) + ": " + message) {}

  /// A fault of a file as a whole, such as one that cannot be opened.
  InputError(const std::string& file, const std::string& message)
      : InputError(file + ": " + message) {}

 private:
  static std::string in_one_line(std::string message) {
    std::replace(message.begin(), message.end(), '\n', ' ');
    std::replace(message.begin(), message.end(), '\r', ' ');
    return message;
  }
};

}  // namespace fathom

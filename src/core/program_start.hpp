#pragma once

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace fathom {

/// Pipes to the three standard streams of a program: the program's ends, which exec closes and
/// which go with this object, and those of this process, which are the caller's to close.
class ProgramPipes {
 public:
  /// Throws EnvironmentError where the system has no pipe left.
  ProgramPipes();
  ~ProgramPipes();
  ProgramPipes(const ProgramPipes&) = delete;
  ProgramPipes& operator=(const ProgramPipes&) = delete;

  // Of its input, stream 0, this process has the end to write to.
  int theirs(std::size_t stream) const { return pairs_[stream][stream == 0 ? 0 : 1]; }
  int ours(std::size_t stream) const { return pairs_[stream][stream == 0 ? 1 : 0]; }

 private:
  std::array<std::array<int, 2>, 3> pairs_{{{-1, -1}, {-1, -1}, {-1, -1}}};
};

/// Starts a program as a shell does, with no signal blocked or ignored; its process number. Throws
/// EnvironmentError where the system does not.
int start_program(const std::string& file, std::vector<std::string> words,
                  const ProgramPipes& pipes);

}  // namespace fathom

#include "apps/child_process.hpp"

#include <array>
#include <cstdio>
#include <cstring>
#include <exception>
#include <sys/wait.h>
#include <unistd.h>

#include "apps/command.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

// The message goes to the parent, which alone prints errors.
[[noreturn]] void be_child(int message, const std::function<void()>& action) {
  int status = kDone;
  try {
    action();
  } catch (const std::exception& error) {
    status = kBadInput;
    [[maybe_unused]] const ssize_t written =
        ::write(message, error.what(), std::strlen(error.what()));
  }
  std::fflush(nullptr);
  ::_exit(status);
}

std::string all_of(int message) {
  std::string text;
  std::array<char, 4096> buffer{};
  for (ssize_t got = 0; (got = ::read(message, buffer.data(), buffer.size())) > 0;) {
    text.append(buffer.data(), static_cast<std::size_t>(got));
  }
  return text;
}

}  // namespace

void in_child_process(const std::string& source, const std::function<void()>& action) {
  std::array<int, 2> message{};
  if (::pipe(message.data()) != 0) throw InputError("the system has no pipe left");
  std::fflush(nullptr);
  const pid_t child = ::fork();
  if (child == 0) {
    ::close(message[0]);
    be_child(message[1], action);
  }
  ::close(message[1]);
  const std::string text = all_of(message[0]);
  ::close(message[0]);
  if (child < 0) throw InputError("the system has no process left");
  int status = 0;
  ::waitpid(child, &status, 0);
  if (WIFEXITED(status) && WEXITSTATUS(status) == kDone) return;
  if (!text.empty()) throw InputError(text);
  throw InputError(source,
                   "is damaged: reading it crashed; 'rosbag check' or 'rosbag reindex' may "
                   "help");
}

}  // namespace fathom

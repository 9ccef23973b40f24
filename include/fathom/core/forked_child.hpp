#pragma once

#include <cstdint>
#include <functional>
#include <stdexcept>
#include <string>

namespace fathom {

/// How a child process ended, and what it left.
struct ChildEnd {
  bool is_late = false;    ///< it was killed at its time limit
  int exit_status = 0;     ///< where no signal ended it
  int signal = 0;          ///< 0: none
  std::string last_lines;  ///< of what it printed, on one line
};

/// What a child sent is no message.
struct DamagedMessage : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// What a child may take.
struct ChildLimits {
  double time_s = 0.0;
  std::int64_t memory_bytes = 0;  ///< of address space beyond what this process has
};

/// With this status a child ends that finds no memory, or crashes with hardly any left.
inline constexpr int kNoMemoryStatus = 86;

/// Where a child writes what the parent is to know, in messages of any size.
class MessagePipe {
 public:
  /// Of the process that makes it.
  explicit MessagePipe(int descriptor);

  /// `kind` is a letter. Blocks until the parent has taken it. Another process, which the child
  /// forked and which went on with its work, ends here: the result is the child's own.
  void send(char kind, const std::string& text) const;

 private:
  int descriptor_;
  int process_;
};

/// Forks a child that does `action` and nothing else, and waits for its end. `on_message` gets what
/// it sends, and is called with kind 0 and no text now and then between messages; what it throws
/// kills the child and is passed on. The child has an end of its own for every descriptor but
/// those that it needs, prints to a pipe, and dies with the thread that called; its process group
/// is killed when it has ended. An EnvironmentError of `action` is thrown here. Throws
/// EnvironmentError also where the system refuses a process, or where the child found no memory
/// while a limit of the system (`ulimit -v`) left it less than its own; DamagedMessage where
/// something else wrote to the pipe.
ChildEnd run_child(const std::function<void(const MessagePipe&)>& action, const ChildLimits& limits,
                   const std::function<void(char, const std::string&)>& on_message);

}  // namespace fathom

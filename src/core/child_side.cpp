#include "child_side.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "fathom/core/environment_error.hpp"

namespace fathom {
namespace {

constexpr int kMessages = 3;  ///< the child's descriptor, after its standard ones

std::int64_t address_space_now() {
  std::int64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * ::sysconf(_SC_PAGESIZE);
}

// What the system allows of it.
std::int64_t limit(__rlimit_resource what, std::int64_t bytes) {
  rlimit now{};
  ::getrlimit(what, &now);
  now.rlim_cur = std::min(static_cast<rlim_t>(bytes), now.rlim_max);
  ::setrlimit(what, &now);
  return static_cast<std::int64_t>(now.rlim_cur);
}

// With it ends a child that finds no memory.
int no_memory_status = kNoMemoryStatus;

// So much has to be left, or a crash is taken for what code in C does that finds no memory.
std::size_t spare_bytes = 0;

void on_crash(int signal) {
  if (::mmap(nullptr, spare_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED) {
    ::_exit(no_memory_status);
  }
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

// On a stack of its own, as the other may have overflown.
void tell_no_memory_from_crash(std::int64_t limit_bytes) {
  static std::array<char, 16384> stack;
  spare_bytes = static_cast<std::size_t>(limit_bytes / 50);
  const stack_t own{stack.data(), 0, stack.size()};
  ::sigaltstack(&own, nullptr);
  struct sigaction action {};
  action.sa_handler = on_crash;
  action.sa_flags = SA_ONSTACK | SA_NODEFER;
  for (const int signal : {SIGSEGV, SIGBUS, SIGABRT}) ::sigaction(signal, &action, nullptr);
}

pid_t own_process = 0;

// A handler, as what is ignored would be so in the programs that a plug-in starts, too. A process
// that it forks ends.
void stay_or_end(int signal) {
  if (::getpid() == own_process) return;
  ::signal(signal, SIG_DFL);
  ::raise(signal);
}

// Whoever ends all processes of a job means the parent, which ends this one in its own time.
void leave_ending_to_parent() {
  own_process = ::getpid();
  struct sigaction action {};
  action.sa_handler = stay_or_end;
  action.sa_flags = SA_RESTART | SA_NODEFER;
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) ::sigaction(signal, &action, nullptr);
}

// The pipes may be anywhere, even where the standard descriptors belong. False with the errno of
// what failed.
bool has_streams(const ChildSide& side) {
  const int messages = ::fcntl(side.messages, F_DUPFD, kMessages + 1);
  if (messages < 0) return false;
  const int printed = ::fcntl(side.printed, F_DUPFD, kMessages + 1);
  if (printed < 0) return false;
  const int null = ::open("/dev/null", O_RDONLY | O_CLOEXEC);
  return null >= 0 && ::dup2(null, STDIN_FILENO) >= 0 && ::dup2(printed, STDOUT_FILENO) >= 0 &&
         ::dup2(printed, STDERR_FILENO) >= 0 && ::dup3(messages, kMessages, O_CLOEXEC) >= 0;
}

[[noreturn]] void fail_by_environment(int messages, const char* what, int error) {
  MessagePipe(messages).send(kEnvironmentFault, EnvironmentError("isolation", what, error).what());
  ::_exit(0);
}

}  // namespace

MessagePipe::MessagePipe(int descriptor) : descriptor_(descriptor), process_(::getpid()) {}

void MessagePipe::send(char kind, const std::string& text) const {
  if (::getpid() != process_) ::_exit(1);
  std::string message(kMessageHead, kind);
  const std::uint64_t size = text.size();
  std::memcpy(message.data() + 1, &size, sizeof size);
  message += text;
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t count = ::write(descriptor_, message.data() + sent, message.size() - sent);
    if (count < 0 && errno != EINTR) ::_exit(1);  // nobody listens
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
}

void be_child(const ChildSide& side, const ChildLimits& limits,
              const std::function<void(const MessagePipe&)>& action) noexcept {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != side.parent) ::_exit(1);  // it died before that
  sigset_t none;
  ::sigemptyset(&none);
  ::pthread_sigmask(SIG_SETMASK, &none, nullptr);
  leave_ending_to_parent();
  if (!has_streams(side)) {
    fail_by_environment(side.messages, "a run's process has no streams", errno);
  }
  // The locks and files of the parent are not the child's to keep open.
  ::close_range(kMessages + 1, ~0U, 0);
  limit(RLIMIT_CORE, 0);
  tell_no_memory_from_crash(limits.memory_bytes);
  const std::int64_t wanted = address_space_now() + limits.memory_bytes;
  if (limit(RLIMIT_AS, wanted) < wanted) no_memory_status = kCutMemoryStatus;
  std::set_new_handler([] { ::_exit(no_memory_status); });
  const MessagePipe pipe(kMessages);
  try {
    action(pipe);
  } catch (const EnvironmentError& error) {
    pipe.send(kEnvironmentFault, error.what());
  } catch (const std::bad_alloc&) {
    ::_exit(no_memory_status);
  }
  std::fflush(nullptr);
  ::_exit(0);
}

}  // namespace fathom

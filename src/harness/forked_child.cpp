#include "forked_child.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <new>
#include <poll.h>
#include <sstream>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

using Clock = std::chrono::steady_clock;

constexpr int kMessages = 3;  ///< the child's descriptor, after its standard ones
constexpr std::size_t kKept = 2000;
constexpr int kLastLines = 3;

struct Pipe {
  std::array<int, 2> ends{-1, -1};

  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) throw InputError("the system has no pipe left");
  }
  ~Pipe() {
    close(0);
    close(1);
  }
  Pipe(const Pipe&) = delete;
  Pipe& operator=(const Pipe&) = delete;

  void close(std::size_t end) {
    if (ends[end] >= 0) ::close(ends[end]);
    ends[end] = -1;
  }
};

std::int64_t address_space_now() {
  std::int64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages * ::sysconf(_SC_PAGESIZE);
}

void limit(__rlimit_resource what, std::int64_t bytes) {
  rlimit now{};
  ::getrlimit(what, &now);
  now.rlim_cur = std::min(static_cast<rlim_t>(bytes), now.rlim_max);
  ::setrlimit(what, &now);
}

// So much has to be left, or a crash is taken for what code in C does that finds no memory.
std::size_t spare_bytes = 0;

void on_crash(int signal) {
  if (::mmap(nullptr, spare_bytes, PROT_NONE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0) == MAP_FAILED) {
    ::_exit(kNoMemoryStatus);
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

[[noreturn]] void be_child(Pipe& messages, Pipe& printed, pid_t parent, const ChildLimits& limits,
                           const std::function<void(const MessagePipe&)>& action) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);  // it died before that
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) std::signal(signal, SIG_DFL);
  const int null = ::open("/dev/null", O_RDONLY);
  ::dup2(null, STDIN_FILENO);
  ::dup2(printed.ends[1], STDOUT_FILENO);
  ::dup2(printed.ends[1], STDERR_FILENO);
  // The locks and files of the parent are not the child's to keep open. The pipes may be anywhere.
  const int own = ::fcntl(messages.ends[1], F_DUPFD, 64);
  ::dup2(own, kMessages);
  ::close_range(kMessages + 1, ~0U, 0);
  limit(RLIMIT_CORE, 0);
  tell_no_memory_from_crash(limits.memory_bytes);
  limit(RLIMIT_AS, address_space_now() + limits.memory_bytes);
  std::set_new_handler([] { ::_exit(kNoMemoryStatus); });
  action(MessagePipe(kMessages));
  std::fflush(nullptr);
  ::_exit(0);
}

// Takes whole messages off what has come: kind, size, text.
class MessageReader {
 public:
  explicit MessageReader(const std::function<void(char, const std::string&)>& on_message)
      : on_message_(on_message) {}

  void add(const char* bytes, std::size_t count) {
    pending_.append(bytes, count);
    while (pending_.size() >= kHead) {
      std::uint64_t size = 0;
      std::memcpy(&size, pending_.data() + 1, sizeof size);
      if (pending_.size() - kHead < size) return;
      on_message_(pending_.front(), pending_.substr(kHead, size));
      pending_.erase(0, kHead + size);
    }
  }

  static constexpr std::size_t kHead = 1 + sizeof(std::uint64_t);

 private:
  const std::function<void(char, const std::string&)>& on_message_;
  std::string pending_;
};

std::string last_lines_of(const std::string& printed) {
  std::string text;
  std::size_t end = printed.find_last_not_of("\n\r \t");
  if (end == std::string::npos) return text;
  ++end;
  for (int line = 0; line < kLastLines && end > 0; ++line) {
    const std::size_t before = printed.find_last_of('\n', end - 1);
    const std::size_t begin = before == std::string::npos ? 0 : before + 1;
    const std::string one = printed.substr(begin, end - begin);
    text = text.empty() ? one : one + " | " + text;
    if (before == std::string::npos) break;
    end = before;
  }
  for (char& letter : text) {
    if (static_cast<unsigned char>(letter) < 0x20) letter = ' ';
  }
  return text;
}

// The parent's side of a child. Whatever happens, nothing of its group is left.
class Child {
 public:
  explicit Child(pid_t id) : id_(id) { ::setpgid(id, id); }
  ~Child() {
    if (is_reaped_) return;
    kill_group();
    reap();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  // The group's number is its own for as long as the child is not reaped.
  void kill_group() const { ::kill(-id_, SIGKILL); }

  bool has_ended() const {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == id_;
  }

  ChildEnd reap() {
    int status = 0;
    while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
    }
    is_reaped_ = true;
    ChildEnd end;
    if (WIFEXITED(status)) end.exit_status = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    return end;
  }

 private:
  pid_t id_;
  bool is_reaped_ = false;
};

// Reads what has come; false at the end of the pipe.
template <class Take>
bool read_some(int descriptor, Take take) {
  std::array<char, 65536> buffer;
  const ssize_t got = ::read(descriptor, buffer.data(), buffer.size());
  if (got < 0) return errno == EINTR || errno == EAGAIN;
  if (got > 0) take(buffer.data(), static_cast<std::size_t>(got));
  return got > 0;
}

ChildEnd watch(Child& child, Pipe& messages, Pipe& printed, const ChildLimits& limits,
               const std::function<void(char, const std::string&)>& on_message) {
  constexpr int kLook = 20;  // ms
  const auto deadline = Clock::now() + std::chrono::duration<double>(limits.time_s);
  MessageReader reader(on_message);
  std::string kept;
  const auto keep = [&kept](const char* bytes, std::size_t count) {
    kept.append(bytes, count);
    if (kept.size() > 2 * kKept) kept.erase(0, kept.size() - kKept);
  };
  const auto read_on = [&reader](const char* bytes, std::size_t count) {
    reader.add(bytes, count);
  };
  bool is_late = false;
  std::array<pollfd, 2> ends{{{messages.ends[0], POLLIN, 0}, {printed.ends[0], POLLIN, 0}}};
  // A process that the child has left holds the pipes open, so that their end is not awaited.
  for (bool has_ended = false; true;) {
    // With both at their end it is about to end, too.
    const int wait_ms = has_ended ? 0 : ends[0].fd < 0 && ends[1].fd < 0 ? 1 : kLook;
    const int ready = ::poll(ends.data(), ends.size(), wait_ms);
    if (ready > 0) {
      if (ends[0].revents != 0 && !read_some(ends[0].fd, read_on)) ends[0].fd = -1;
      if (ends[1].revents != 0 && !read_some(ends[1].fd, keep)) ends[1].fd = -1;
      if (ends[0].fd >= 0 || ends[1].fd >= 0) {
        if (has_ended || Clock::now() < deadline) continue;
      }
    }
    if (has_ended) break;
    on_message(0, "");
    has_ended = child.has_ended();
    if (has_ended || Clock::now() < deadline) continue;
    is_late = true;
    child.kill_group();
    while (!child.has_ended()) ::poll(nullptr, 0, 1);
    has_ended = true;
  }
  child.kill_group();
  ChildEnd end = child.reap();
  end.is_late = is_late;
  end.last_lines = last_lines_of(kept);
  return end;
}

}  // namespace

ChildFailure failure_of(const ChildEnd& end, const ChildLimits& limits) {
  ChildFailure failure;
  if (end.is_late) {
    std::ostringstream seconds;
    seconds << limits.time_s;
    failure = {Outcome::timed_out, "was killed after " + seconds.str() + " s"};
  } else if (end.exit_status == kNoMemoryStatus || end.signal == SIGKILL) {
    // The system kills where it has no memory left itself.
    failure = {Outcome::out_of_memory,
               "found no memory within " + std::to_string(limits.memory_bytes >> 20) + " MiB"};
  } else if (end.signal != 0) {
    failure = {Outcome::crashed, "was ended by signal " + std::to_string(end.signal) + " (" +
                                     ::strsignal(end.signal) + ")"};
  } else {
    failure = {Outcome::crashed,
               "ended its process itself, with status " + std::to_string(end.exit_status)};
  }
  if (!end.last_lines.empty()) failure.how += "; it printed last: " + end.last_lines;
  return failure;
}

void MessagePipe::send(char kind, const std::string& text) const {
  std::string message(MessageReader::kHead, kind);
  const std::uint64_t size = text.size();
  std::memcpy(message.data() + 1, &size, sizeof size);
  message += text;
  for (std::size_t sent = 0; sent < message.size();) {
    const ssize_t count = ::write(descriptor_, message.data() + sent, message.size() - sent);
    if (count < 0 && errno != EINTR) ::_exit(1);  // nobody listens
    if (count > 0) sent += static_cast<std::size_t>(count);
  }
}

ChildEnd run_child(const std::function<void(const MessagePipe&)>& action, const ChildLimits& limits,
                   const std::function<void(char, const std::string&)>& on_message) {
  Pipe messages;
  Pipe printed;
  std::fflush(nullptr);
  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id < 0) throw InputError("the system has no process left for a run");
  if (id == 0) be_child(messages, printed, parent, limits, action);
  Child child(id);
  messages.close(1);
  printed.close(1);
  return watch(child, messages, printed, limits, on_message);
}

}  // namespace fathom

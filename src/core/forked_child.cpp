#include "fathom/core/forked_child.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "child_side.hpp"
#include "fathom/core/environment_error.hpp"
#include "fathom/core/system.hpp"
#include "last_lines.hpp"
#include "processor_limit.hpp"
#include "time_value.hpp"

namespace fathom {
namespace {

using Clock = std::chrono::steady_clock;

constexpr std::uint64_t kMostBytes = std::uint64_t{1} << 36;

// The time that this process was awake: what passes while it and the child are suspended is not the
// child's, and a child that is not suspended with it may wait for it to take its result.
class TimeAwake {
 public:
  // To be called more often than every 100 ms.
  double seconds() {
    constexpr std::chrono::duration<double> kLongestStep{0.1};
    const auto now = Clock::now();
    awake_ += std::min<std::chrono::duration<double>>(now - last_, kLongestStep);
    last_ = now;
    return awake_.count();
  }

 private:
  Clock::time_point last_ = Clock::now();
  std::chrono::duration<double> awake_{0.0};
};

struct Pipe {
  std::array<int, 2> ends{-1, -1};

  Pipe() {
    if (::pipe2(ends.data(), O_CLOEXEC) == 0) return;
    throw EnvironmentError("isolation", "no pipe can be made for a run's process", errno);
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

// Takes whole messages off what has come: kind, size, text.
class MessageReader {
 public:
  explicit MessageReader(const std::function<void(char, const std::string&)>& on_message)
      : on_message_(on_message) {}

  void add(const char* bytes, std::size_t count) {
    pending_.append(bytes, count);
    while (pending_.size() >= kMessageHead) {
      std::uint64_t size = 0;
      std::memcpy(&size, pending_.data() + 1, sizeof size);
      if (size > kMostBytes) throw DamagedMessage("a message is damaged");
      if (pending_.size() - kMessageHead < size) return;
      on_message_(pending_.front(), pending_.substr(kMessageHead, size));
      pending_.erase(0, kMessageHead + size);
    }
  }

 private:
  const std::function<void(char, const std::string&)>& on_message_;
  std::string pending_;
};

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

  // The numbers are its own for as long as the child is not reaped. It may have left its group.
  void kill_group() const {
    ::kill(-id_, SIGKILL);
    ::kill(id_, SIGKILL);
  }

  bool has_ended() const {
    siginfo_t info{};
    return ::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
           info.si_pid == id_;
  }

  ChildEnd reap() {
    int status = 0;
    rusage used{};
    while (::wait4(id_, &status, 0, &used) < 0 && errno == EINTR) {
    }
    is_reaped_ = true;
    processor_s_ = seconds(used.ru_utime) + seconds(used.ru_stime);
    ChildEnd end;
    if (WIFEXITED(status)) end.exit_status = WEXITSTATUS(status);
    if (WIFSIGNALED(status)) end.signal = WTERMSIG(status);
    return end;
  }

  /// After its end.
  double processor_s() const { return processor_s_; }

 private:
  pid_t id_;
  bool is_reaped_ = false;
  double processor_s_ = 0.0;
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
  constexpr int kLook_ms = 20;
  TimeAwake awake;
  MessageReader reader(on_message);
  std::string kept;
  const auto keep = [&kept](const char* bytes, std::size_t count) {
    keep_print(bytes, count, kept);
  };
  const auto read_on = [&reader](const char* bytes, std::size_t count) {
    reader.add(bytes, count);
  };
  std::array<pollfd, 2> ends{{{messages.ends[0], POLLIN, 0}, {printed.ends[0], POLLIN, 0}}};
  const auto read_ready = [&](int wait_ms) {
    if (::poll(ends.data(), ends.size(), wait_ms) <= 0) return false;
    if (ends[0].revents != 0 && !read_some(ends[0].fd, read_on)) ends[0].fd = -1;
    if (ends[1].revents != 0 && !read_some(ends[1].fd, keep)) ends[1].fd = -1;
    return true;
  };
  bool is_late = false;
  // A process that the child has left holds the pipes open, so that their end is not awaited.
  for (auto look_at = Clock::now(); true;) {
    const bool is_over = ends[0].fd < 0 && ends[1].fd < 0;  // about to end, too
    if (read_ready(is_over ? 1 : kLook_ms) && Clock::now() < look_at) continue;
    look_at = Clock::now() + std::chrono::milliseconds(kLook_ms);
    on_message(0, "");
    if (child.has_ended()) break;
    if (awake.seconds() < limits.time_s) continue;
    is_late = true;
    child.kill_group();
    while (!child.has_ended()) ::poll(nullptr, 0, 1);
    break;
  }
  child.kill_group();
  // What is still in the pipes; a process that has left the group may write for ever.
  const auto until = Clock::now() + std::chrono::seconds(1);
  while (read_ready(0) && Clock::now() < until) {
  }
  ChildEnd end = child.reap();
  end.is_late = is_late;
  end.last_lines = last_lines_of(kept);
  return end;
}

// The limit was the system's, and says nothing of what was run.
EnvironmentError memory_is_cut(const ChildLimits& limits) {
  rlimit now{};
  ::getrlimit(RLIMIT_AS, &now);
  return EnvironmentError(
      "memory_limit_mib: a run found no memory, as 'ulimit -v' gives this program " +
      std::to_string(now.rlim_max >> 20) + " MiB, and the run may have " +
      std::to_string(limits.memory_bytes >> 20) +
      " MiB beside what the program has; raise the one or lower the other");
}

}  // namespace

ChildEnd run_child(const std::function<void(const MessagePipe&)>& action, const ChildLimits& limits,
                   const std::function<void(char, const std::string&)>& on_message) {
  Pipe messages;
  Pipe printed;
  std::fflush(nullptr);
  // What this process keeps for later is neither the child's to use beside its limit, nor to copy.
  return_free_memory();
  const pid_t parent = ::getpid();
  const pid_t id = ::fork();
  if (id < 0) throw EnvironmentError("isolation", "a run gets no process of its own", errno);
  if (id == 0) be_child({messages.ends[1], printed.ends[1], parent}, limits, action);
  Child child(id);
  messages.close(1);
  printed.close(1);
  std::string fault;
  ChildEnd end = watch(child, messages, printed, limits, [&](char kind, const std::string& text) {
    if (kind == kEnvironmentFault) {
      fault = text;
    } else {
      on_message(kind, text);
    }
  });
  if (!fault.empty()) throw EnvironmentError(fault);
  if (end.exit_status == kCutMemoryStatus) throw memory_is_cut(limits);
  if (!end.is_late) refuse_processor_limit(end.signal, child.processor_s());
  return end;
}

}  // namespace fathom

#include "forked_child.hpp"

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sstream>
#include <sys/wait.h>
#include <unistd.h>

#include "child_side.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {
namespace {

using Clock = std::chrono::steady_clock;

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
  if (id == 0) be_child({messages.ends[1], printed.ends[1], parent}, limits, action);
  Child child(id);
  messages.close(1);
  printed.close(1);
  return watch(child, messages, printed, limits, on_message);
}

}  // namespace fathom

#include "fathom/core/program.hpp"

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <ctime>
#include <fcntl.h>
#include <fstream>
#include <poll.h>
#include <sstream>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include "last_lines.hpp"
#include "processor_limit.hpp"
#include "program_start.hpp"
#include "time_value.hpp"

namespace fathom {
namespace {

// A line of /proc/ID/status in KiB: the largest resident memory of a process that runs.
std::int64_t resident_peak_bytes(const std::string& process) {
  std::ifstream status("/proc/" + process + "/status");
  for (std::string word; status >> word;) {
    if (word != "VmHWM:") continue;
    std::int64_t kib = 0;
    status >> kib;
    return kib << 10;
  }
  return 0;
}

// Of the programs that a running process has waited for: fields 16 and 17 of its stat, counted from
// behind its name, which may have spaces.
double waited_children_s(int id) {
  std::ifstream file("/proc/" + std::to_string(id) + "/stat");
  std::string text;
  std::getline(file, text);
  const std::size_t name_end = text.rfind(')');
  if (name_end == std::string::npos) return 0.0;
  std::istringstream fields(text.substr(name_end + 1));
  std::string skipped;
  for (int field = 3; field < 16; ++field) fields >> skipped;
  double user = 0.0;
  double system = 0.0;
  fields >> user >> system;
  return (user + system) / static_cast<double>(::sysconf(_SC_CLK_TCK));
}

// Writing to a pipe that nobody reads is an error here, not the end of the program.
ssize_t write_without_signal(int descriptor, std::string_view text) {
  sigset_t pipe_signal;
  sigset_t before;
  ::sigemptyset(&pipe_signal);
  ::sigaddset(&pipe_signal, SIGPIPE);
  ::pthread_sigmask(SIG_BLOCK, &pipe_signal, &before);
  const ssize_t written = ::write(descriptor, text.data(), text.size());
  const int error = errno;
  if (written < 0 && error == EPIPE) {
    const timespec at_once{0, 0};
    ::sigtimedwait(&pipe_signal, nullptr, &at_once);
  }
  ::pthread_sigmask(SIG_SETMASK, &before, nullptr);
  errno = error;
  return written;
}

}  // namespace

Program::Program(const std::vector<std::string>& words) : name_(words.front()) {
  ProgramPipes pipes;
  for (std::size_t stream = 0; stream < 3; ++stream) ends_[stream] = pipes.ours(stream);
  ::fcntl(ends_[input], F_SETFL, O_NONBLOCK);
  try {
    id_ = start_program(find_program(name_), words, pipes);
    own_bytes_ = resident_peak_bytes("self");
  } catch (...) {
    for (const Stream stream : {input, output, errors}) close(stream);
    throw;
  }
}

Program::~Program() {
  for (const Stream stream : {input, output, errors}) close(stream);
  if (is_reaped_) return;
  ::kill(id_, SIGKILL);
  reap();
}

void Program::close(Stream stream) {
  if (ends_[stream] >= 0) ::close(ends_[stream]);
  ends_[stream] = -1;
}

void Program::take(Stream stream) {
  std::array<char, 65536> buffer;
  const ssize_t got = ::read(ends_[stream], buffer.data(), buffer.size());
  if (got < 0 && errno == EINTR) return;
  if (got <= 0) return close(stream);
  const auto count = static_cast<std::size_t>(got);
  if (stream == errors) return keep_print(buffer.data(), count, errors_);
  output_.erase(0, read_);
  read_ = 0;
  output_.append(buffer.data(), count);
}

bool Program::wait_ready(bool to_write) {
  constexpr int kLook_ms = 20;
  std::array<pollfd, 3> all{{{to_write ? ends_[input] : -1, POLLOUT, 0},
                             {ends_[output], POLLIN, 0},
                             {ends_[errors], POLLIN, 0}}};
  // What it had in use is not to be seen any more when it has ended.
  peak_bytes_ = std::max(peak_bytes_, resident_peak_bytes(std::to_string(id_)));
  if (::poll(all.data(), all.size(), kLook_ms) <= 0) return false;
  if (all[output].revents != 0) take(output);
  if (all[errors].revents != 0) take(errors);
  return !to_write || all[input].revents != 0;
}

void Program::send(std::string_view text) {
  while (!text.empty()) {
    if (!wait_ready(true)) {
      refuse_ended();
      continue;
    }
    const ssize_t count = write_without_signal(ends_[input], text);
    if (count < 0 && errno != EAGAIN && errno != EINTR) fail("reads no more");
    if (count > 0) text.remove_prefix(static_cast<std::size_t>(count));
  }
}

std::string Program::next_line() {
  constexpr std::size_t kLongest = std::size_t{1} << 20;
  for (;;) {
    const std::size_t end = output_.find('\n', read_);
    if (end != std::string::npos) {
      std::string line = output_.substr(read_, end - read_);
      read_ = end + 1;
      return line;
    }
    if (output_.size() - read_ > kLongest) fail("prints a line without end");
    if (ends_[output] < 0) fail("ended, or closed its output");
    if (!wait_ready(false)) refuse_ended();
  }
}

void Program::refuse_ended() {
  // What it has left running may hold its streams open.
  if (has_ended() && !wait_ready(false)) fail("ended");
}

void Program::reap() {
  rusage used{};
  while (::wait4(id_, &status_, 0, &used) < 0 && errno == EINTR) {
  }
  is_reaped_ = true;
  processor_s_ = seconds(used.ru_utime) + seconds(used.ru_stime);
  // It counts this process as it was before exec, up to pages that the kernel had not added yet.
  constexpr std::int64_t kNotAdded = std::int64_t{1} << 20;
  const std::int64_t peak = std::int64_t{used.ru_maxrss} << 10;
  if (peak > own_bytes_ + kNotAdded) peak_bytes_ = std::max(peak_bytes_, peak);
}

bool Program::has_ended() const {
  siginfo_t info{};
  return ::waitid(P_PID, static_cast<id_t>(id_), &info, WEXITED | WNOHANG | WNOWAIT) == 0 &&
         info.si_pid == id_;
}

void Program::finish() {
  close(input);
  while (ends_[output] >= 0 || ends_[errors] >= 0) {
    wait_ready(false);
    read_ = output_.size();
    // What it has left running may hold its streams open.
    if (has_ended() && !wait_ready(false)) break;
  }
  reap();
  if (status_ != 0) fail("failed");
}

void Program::await_end() {
  // Its streams close a moment before its status can be had, so they do not tell its end.
  const auto latest = std::chrono::steady_clock::now() + std::chrono::seconds(2);
  bool is_silent = false;
  while (!(has_ended() && is_silent) && std::chrono::steady_clock::now() < latest) {
    is_silent = !wait_ready(false);
    read_ = output_.size();
  }
  if (has_ended()) reap();
}

void Program::fail(const std::string& why) {
  if (!is_reaped_) await_end();
  std::string text = "'" + name_ + "' " + why;
  if (is_reaped_ && WIFSIGNALED(status_)) {
    refuse_processor_limit(WTERMSIG(status_), processor_s_);
    text += ": signal " + std::to_string(WTERMSIG(status_)) + " (" +
            ::strsignal(WTERMSIG(status_)) + ")";
  } else if (is_reaped_ && WEXITSTATUS(status_) != 0) {
    text += ": status " + std::to_string(WEXITSTATUS(status_));
  }
  const std::string last = last_lines_of(errors_);
  if (!last.empty()) text += "; it printed last: " + last;
  throw ProgramFailure(text);
}

double Program::processor_s() const {
  if (is_reaped_) return processor_s_;
  clockid_t clock{};
  timespec now{};
  if (::clock_getcpuclockid(id_, &clock) != 0 || ::clock_gettime(clock, &now) != 0) return 0.0;
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec) +
         waited_children_s(id_);
}

std::int64_t Program::peak_bytes() {
  if (!is_reaped_) {
    peak_bytes_ = std::max(peak_bytes_, resident_peak_bytes(std::to_string(id_)));
  }
  return peak_bytes_;
}

}  // namespace fathom

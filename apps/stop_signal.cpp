#include "apps/stop_signal.hpp"

#include <chrono>
#include <csignal>
#include <cstdio>
#include <string_view>
#include <unistd.h>
#include <utility>

#include "apps/command.hpp"

namespace fathom {
namespace {

std::atomic<bool> stop_asked = false;
std::atomic<bool> by_a_person = false;
std::atomic<bool> stop_silently = false;

// A signal handler may call little else.
void say_from_signal(std::string_view text) noexcept {
  // What cannot be said is not said.
  [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text.data(), text.size());
}

extern "C" void ask_to_stop(int signal) {
  if (signal == SIGINT) by_a_person = true;
  stop_asked = true;
  std::signal(signal, SIG_DFL);
  if (stop_silently) return;
  say_from_signal(
      "\nfathom: stopping: the trials at work end at their next keyframe, and what is registered "
      "is kept; again to end at once\n");
}

}  // namespace

StopSignal::StopSignal(bool quiet, std::function<void()> keep) : keep_(std::move(keep)) {
  stop_silently = quiet;
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
  watch_ = std::thread([this] { watch(); });
}

StopSignal::~StopSignal() {
  {
    const std::lock_guard hold(mutex_);
    is_ended_ = true;
  }
  ended_.notify_all();
  watch_.join();
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
}

const std::atomic<bool>* StopSignal::flag() const {
  return &stop_asked;
}

// A signal may wake nobody, so it is looked for.
void StopSignal::watch() {
  using namespace std::chrono_literals;
  std::unique_lock hold(mutex_);
  while (!ended_.wait_for(hold, 100ms, [this] { return is_ended_; })) {
    if (!stop_asked || !by_a_person) continue;
    if (ended_.wait_for(hold, 2500ms, [this] { return is_ended_; })) return;
    keep_();
    std::fprintf(stderr,
                 "fathom: stopped in the middle of a trial; what was stored and registered is "
                 "kept. The same command goes on from there.\n");
    ::_exit(kStopped);
  }
}

}  // namespace fathom

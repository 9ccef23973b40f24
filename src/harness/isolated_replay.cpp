#include "fathom/harness/isolated_replay.hpp"

#include <chrono>
#include <cstring>
#include <exception>
#include <optional>
#include <string>

#include "child_failure.hpp"
#include "fathom/core/environment_error.hpp"
#include "run_bytes.hpp"

namespace fathom {
namespace {

// The kinds of messages of a child.
constexpr char kProgress = 'p';
constexpr char kReplay = 'r';
constexpr char kBadInput = 'i';

// Progress in pieces that cost a run nothing.
class RarelySent {
 public:
  explicit RarelySent(const MessagePipe& parent) : parent_(parent) {}

  void operator()(std::size_t done, std::size_t of) {
    const auto now = std::chrono::steady_clock::now();
    if (now - last_ < std::chrono::milliseconds(50) && done < of) return;
    last_ = now;
    const std::size_t both[2] = {done, of};
    parent_.send(kProgress, {reinterpret_cast<const char*>(both), sizeof both});
  }

 private:
  MessagePipe parent_;
  std::chrono::steady_clock::time_point last_{};
};

void replay_in_child(const MessagePipe& parent, const MeasurementLog& log,
                     const EstimatorEntry& entry, const EstimatorValues& values,
                     ReplayOptions options) {
  if (options.progress) options.progress = RarelySent(parent);
  try {
    parent.send(kReplay, bytes_of(replay(log, entry, values, options)));
  } catch (const EnvironmentError&) {
    throw;
  } catch (const InputError& error) {
    parent.send(kBadInput, error.what());
  }
}

// What a child with a damaged heap sends may be anything.
Run whole_run(const std::string& bytes, const MeasurementLog& log, const ReplayOptions& options) {
  try {
    return run_of(bytes, log, options);
  } catch (const std::exception& error) {
    throw DamagedMessage(error.what());
  }
}

}  // namespace

Run isolated_replay(const MeasurementLog& log, const EstimatorEntry& entry,
                    const EstimatorValues& values, const ReplayOptions& options,
                    const ProcessLimits& limits) {
  std::optional<Run> result;
  std::string bad_input;
  std::size_t at[2] = {0, log.size()};
  const auto on_message = [&](char kind, const std::string& text) {
    if (kind == kReplay) result = whole_run(text, log, options);
    if (kind == kBadInput) bad_input = text;
    if (kind == kProgress && text.size() == sizeof at) std::memcpy(at, text.data(), sizeof at);
    // A run that says nothing can be stopped, too.
    if (options.progress && (kind == kProgress || kind == 0)) options.progress(at[0], at[1]);
  };
  ChildEnd end;
  try {
    end = run_child(
        [&](const MessagePipe& parent) { replay_in_child(parent, log, entry, values, options); },
        {limits.time_s, limits.memory_bytes}, on_message);
  } catch (const DamagedMessage& damage) {
    return lost_run(log, options, Outcome::crashed,
                    std::string("damaged what it sent back: ") + damage.what());
  }
  if (!bad_input.empty()) throw InputError(bad_input);
  if (result && end.signal == 0 && end.exit_status == 0) return std::move(*result);
  const ChildFailure failure = failure_of(end, {limits.time_s, limits.memory_bytes});
  return lost_run(log, options, failure.outcome, failure.how);
}

std::optional<Outcome> end_of_process(const std::string& name) {
  for (const Outcome one : {Outcome::crashed, Outcome::timed_out, Outcome::out_of_memory}) {
    if (name == name_of(one)) return one;
  }
  return std::nullopt;
}

}  // namespace fathom

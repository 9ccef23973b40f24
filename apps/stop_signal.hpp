#pragma once

#include <atomic>
#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace fathom {

/// Lets SIGINT and SIGTERM stop long work: as long as this lives the first one sets a flag that the
/// work looks at, and says so unless quiet; the second ends the program. Work that does not come to
/// look at its flag within 2.5 s of SIGINT (a solve of a large map, the drawing of a floor) is
/// ended with the program, since a person waits; a scheduler's SIGTERM waits for the work.
class StopSignal {
 public:
  /// `keep` saves what is to be kept before the program is ended in the middle of its work, which
  /// goes on beside it.
  StopSignal(bool quiet, std::function<void()> keep);
  ~StopSignal();
  StopSignal(const StopSignal&) = delete;
  StopSignal& operator=(const StopSignal&) = delete;

  const std::atomic<bool>* flag() const;

 private:
  void watch();

  std::function<void()> keep_;
  std::mutex mutex_;
  std::condition_variable ended_;
  bool is_ended_ = false;
  std::thread watch_;
};

}  // namespace fathom

#pragma once

#include <mutex>

namespace fathom {

/// What is done when it is first asked for. Threads may ask at once, and wait for it. What throws
/// is done again the next time. (std::call_once promises the same, but hangs under
/// ThreadSanitizer after an exception.)
class Once {
 public:
  template <class Action>
  void call(Action action) {
    const std::lock_guard lock(mutex_);
    if (is_done_) return;
    action();
    is_done_ = true;
  }

 private:
  std::mutex mutex_;
  bool is_done_ = false;
};

}  // namespace fathom

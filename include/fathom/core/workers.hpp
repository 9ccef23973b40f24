#pragma once

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <functional>
#include <mutex>
#include <thread>
#include <vector>

namespace fathom {

/// Threads that work on the tasks of the one that made them, the caller among them. They sleep
/// between tasks. Where the system refuses threads there are fewer, and they do the same work.
class Workers {
 public:
  /// `threads` in all, at least 1.
  explicit Workers(int threads);
  ~Workers();
  Workers(const Workers&) = delete;
  Workers& operator=(const Workers&) = delete;

  /// How many there are, the caller among them.
  int size() const { return static_cast<int>(helpers_.size()) + 1; }

  /// Calls part(0) … part(size() − 1) at the same time, part(0) on the calling thread, and returns
  /// once all have. A part must not throw. One caller at a time.
  void run(const std::function<void(int)>& part);

 private:
  void help(int worker);

  std::mutex mutex_;
  std::condition_variable begun_;
  std::condition_variable done_;
  const std::function<void(int)>* part_ = nullptr;
  long task_ = 0;             ///< counts the tasks; −1: no more will come
  int at_work_ = 0;           ///< helpers that have not done the present task
  double cpu_seconds_ = 0.0;  ///< of helpers, for the present task
  std::vector<std::jthread> helpers_;
};

/// Processor time of this thread so far, and of what Workers did for it, in seconds.
double thread_processor_seconds();

/// Where the parts of a task wait for each other. They wait awake: it is for waits of microseconds.
class Barrier {
 public:
  explicit Barrier(int parts) : parts_(parts) {}

  /// Returns once all parts have called it; what they wrote before it is seen.
  void wait();

 private:
  int parts_;
  std::atomic<int> waiting_{0};
  std::atomic<unsigned> round_{0};
};

/// Waits, awake, until is_true(), which another part of the same task makes true.
template <class Condition>
void wait_until(const Condition& is_true) {
  constexpr int kSpins = 2000;
  for (int i = 0; !is_true(); ++i) {
    // Another thread may need the processor to make it true.
    if (i > kSpins) std::this_thread::yield();
  }
}

/// body(begin, end) for ranges of at most `grain` that make up [0, count), by whoever is free; by
/// the caller at once where `workers` is null.
template <class Body>
void for_ranges(Workers* workers, std::size_t count, std::size_t grain, const Body& body) {
  if (workers == nullptr || count <= grain) {
    if (count > 0) body(std::size_t{0}, count);
    return;
  }
  std::atomic<std::size_t> next{0};
  workers->run([&](int) {
    for (;;) {
      const std::size_t begin = next.fetch_add(grain);
      if (begin >= count) return;
      body(begin, std::min(count, begin + grain));
    }
  });
}

}  // namespace fathom

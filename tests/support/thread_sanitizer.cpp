// In the preset tsan alone: OpenCV's loops run on threads that ThreadSanitizer sees. TBB is not
// instrumented, so that it takes every loop for a race, and a real one would be lost among them.

#include <algorithm>
#include <atomic>
#include <memory>
#include <thread>
#include <vector>

#include <opencv2/core/parallel/parallel_backend.hpp>

namespace {

class VisibleThreads : public cv::parallel::ParallelForAPI {
 public:
  void parallel_for(int tasks, FN_parallel_for_body_cb_t body, void* data) override {
    std::atomic<int> next = 0;
    const auto work = [&](int number) {
      number_ = number;
      for (int task = next++; task < tasks; task = next++) body(task, task + 1, data);
    };
    std::vector<std::jthread> others;
    for (int i = 1; i < std::min(tasks, threads_.load()); ++i) others.emplace_back(work, i);
    work(0);
  }

  int getThreadNum() const override { return number_; }
  int getNumThreads() const override { return threads_; }
  int setNumThreads(int count) override { return threads_.exchange(std::max(count, 1)); }
  const char* getName() const override { return "visible threads"; }

 private:
  static inline thread_local int number_ = 0;
  std::atomic<int> threads_ = 2;
};

[[maybe_unused]] const bool kIsInstalled = [] {
  cv::parallel::setParallelForBackend(std::make_shared<VisibleThreads>(), false);
  return true;
}();

}  // namespace

// What is synchronised inside a library that is not instrumented.
extern "C" const char* __tsan_default_suppressions() {
  return "race:cv::Mat::deallocate\n"  // by the reference count of a picture
         "deadlock:libgdal.so\n";      // a lock of OpenCV's picture codecs, at start
}

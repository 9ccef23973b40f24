#pragma once

namespace fathom {

/// As long as it lives BLAS and OpenMP have one thread, as costs are measured on one; afterwards
/// what they had.
class OneThread {
 public:
  OneThread();
  ~OneThread();
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

  /// Of a thread that began since: OpenMP asks each for itself.
  static void pin_this_thread();

 private:
  int blas_threads_;
  int active_levels_;
};

}  // namespace fathom

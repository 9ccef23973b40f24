#pragma once

namespace fathom {

/// As long as one of these lives BLAS has one thread, and OpenMP on this thread, as costs are
/// measured on one; afterwards what they had.
class OneThread {
 public:
  OneThread();
  ~OneThread();
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

  /// Of a thread that began since: OpenMP asks each for itself.
  static void pin_this_thread();

 private:
  int active_levels_;  ///< of this thread: OpenMP keeps them for each
};

}  // namespace fathom

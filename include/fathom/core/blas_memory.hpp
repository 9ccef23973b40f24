#pragma once

#include <mutex>

namespace fathom {

/// Stands around calls of BLAS that may come from several threads. OpenBLAS works in a buffer of
/// 128 MiB of addresses, one for each thread that calls at the same time, and keeps it.
///
/// - Where the system has no addresses left OpenBLAS asks again and again, for ever. Throws
///   std::bad_alloc instead.
/// - An OpenBLAS that was built for one thread has no lock on its buffers: two threads can be given
///   the same one, and their results are wrong. There one call waits for the other.
class BlasMemory {
 public:
  BlasMemory();
  ~BlasMemory();
  BlasMemory(const BlasMemory&) = delete;
  BlasMemory& operator=(const BlasMemory&) = delete;

 private:
  std::unique_lock<std::mutex> alone_;
};

}  // namespace fathom

#pragma once

namespace fathom {

/// Stands around calls of BLAS. OpenBLAS works in a buffer of 128 MiB of addresses, one for each
/// thread that calls at the same time, and keeps it; where the system has none left it asks again
/// and again, for ever. Throws std::bad_alloc instead.
class BlasMemory {
 public:
  BlasMemory();
  ~BlasMemory();
  BlasMemory(const BlasMemory&) = delete;
  BlasMemory& operator=(const BlasMemory&) = delete;
};

}  // namespace fathom

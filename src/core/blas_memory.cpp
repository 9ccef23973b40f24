#include "fathom/core/blas_memory.hpp"

#include <cblas.h>
#include <cstddef>
#include <mutex>
#include <new>
#include <sys/mman.h>

namespace fathom {
namespace {

// The buffer, and what other threads may take before it is made.
constexpr std::size_t kBytes = (128U + 32U) << 20U;

std::mutex one_call;  // where OpenBLAS has no locks

std::mutex mutex;
int in_use = 0;
int made = 0;

void require_addresses() {
  void* const probe =
      ::mmap(nullptr, kBytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (probe == MAP_FAILED) throw std::bad_alloc();
  ::munmap(probe, kBytes);
}

}  // namespace

BlasMemory::BlasMemory() {
  if (openblas_get_parallel() == OPENBLAS_SEQUENTIAL) alone_ = std::unique_lock(one_call);
  const std::lock_guard lock(mutex);
  if (in_use == made) {
    require_addresses();
    ++made;
  }
  ++in_use;
}

BlasMemory::~BlasMemory() {
  const std::lock_guard lock(mutex);
  --in_use;
}

}  // namespace fathom

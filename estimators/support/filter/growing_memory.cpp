#include "estimators/support/filter/growing_memory.hpp"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <new>
#include <sys/mman.h>

namespace fathom::filter {
namespace {

constexpr std::size_t kCacheLine = 64;
// Pages of this size, where the system has them to give, make reading on across their borders as
// fast as within: a pass over a large triangle takes a third less.
constexpr std::size_t kHugePage = std::size_t{2} * 1024 * 1024;
constexpr std::size_t kSmallest = std::size_t{64} * 1024;

std::size_t rounded_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

}  // namespace

void GrowingMemory::Free::operator()(double* memory) const {
  std::free(memory);
}

double* GrowingMemory::take(std::size_t count) {
  const std::size_t needed = rounded_up(count * sizeof(double), kCacheLine);
  if (needed > left_ * sizeof(double)) {
    const bool huge = bytes_ + needed >= kHugePage / 2;
    std::size_t slab = std::max({needed, bytes_ / 8, kSmallest});
    const std::size_t alignment = huge ? kHugePage : kCacheLine;
    slab = rounded_up(slab, alignment);
    auto* memory = static_cast<double*>(std::aligned_alloc(alignment, slab));
    if (memory == nullptr) throw std::bad_alloc();
    slabs_.emplace_back(memory);
    if (huge) {
      // What the heap kept of others may be in small pages: it goes, and comes again in large ones.
      madvise(memory, slab, MADV_DONTNEED);
      madvise(memory, slab, MADV_HUGEPAGE);
    }
    next_ = memory;
    left_ = slab / sizeof(double);
    bytes_ += slab;
  }
  double* const taken = next_;
  std::memset(taken, 0, needed);
  next_ += needed / sizeof(double);
  left_ -= needed / sizeof(double);
  return taken;
}

}  // namespace fathom::filter

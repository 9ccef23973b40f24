#include "estimators/support/sparse/panel_memory.hpp"

#include <cstdint>
#include <cstdlib>
#include <new>
#include <sys/mman.h>

namespace fathom::sparse {
namespace {

constexpr std::size_t kCacheLine = 64;
constexpr std::size_t kPage = 4096;
constexpr std::size_t kHugePage = std::size_t{2} * 1024 * 1024;
constexpr std::size_t kHugeFrom = 4 * kHugePage;
// From here on malloc may take pages of their own, which are new.
constexpr std::size_t kFreshPages = std::size_t{128} * 1024;
// Bytes that a thread asks for at a time.
constexpr std::size_t kPagesAtOnce = std::size_t{4} * 1024 * 1024;

std::size_t rounded_up(std::size_t bytes, std::size_t unit) {
  return (bytes + unit - 1) / unit * unit;
}

// A hint: systems without it, older than Linux 5.14, refuse it and nothing is lost.
void ask_for_pages(double* memory, std::size_t bytes, Workers* workers) {
#ifdef MADV_POPULATE_WRITE
  const auto address = reinterpret_cast<std::uintptr_t>(memory);
  const std::size_t skipped = rounded_up(address, kPage) - address;
  const std::size_t whole = (bytes - skipped) / kPage * kPage;
  char* const first = reinterpret_cast<char*>(memory) + skipped;
  for_ranges(workers, whole, kPagesAtOnce, [first](std::size_t begin, std::size_t end) {
    madvise(first + begin, end - begin, MADV_POPULATE_WRITE);
  });
#else
  static_cast<void>(memory);
  static_cast<void>(bytes);
  static_cast<void>(workers);
#endif
}

}  // namespace

void PanelMemory::Free::operator()(double* memory) const {
  std::free(memory);
}

PanelMemory::PanelMemory(std::size_t count, Workers* workers) : count_(count) {
  const std::size_t alignment = count * sizeof(double) >= kHugeFrom ? kHugePage : kCacheLine;
  const std::size_t bytes = rounded_up(count * sizeof(double), alignment);
  own_.reset(static_cast<double*>(std::aligned_alloc(alignment, bytes)));
  if (!own_) throw std::bad_alloc();
  numbers_ = own_.get();
  // A factor is gone through in long strides, each of which else misses the table of pages.
  if (alignment == kHugePage) madvise(numbers_, bytes, MADV_HUGEPAGE);
  if (bytes >= kFreshPages) ask_for_pages(numbers_, bytes, workers);
}

}  // namespace fathom::sparse

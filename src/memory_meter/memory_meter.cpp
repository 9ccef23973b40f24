#include "fathom/memory_meter/memory_meter.hpp"

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdint>
#include <malloc.h>
#include <sys/mman.h>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define FATHOM_OWN_MALLOC 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define FATHOM_OWN_MALLOC 0
#endif
#endif
#ifndef FATHOM_OWN_MALLOC
#define FATHOM_OWN_MALLOC 1
#endif

#if !FATHOM_OWN_MALLOC

namespace fathom {

std::unique_ptr<MemoryMeter> make_memory_meter() {
  return nullptr;
}

}  // namespace fathom

#else

namespace {

// Plain thread-locals with constant initialisation: malloc runs before any constructor.
thread_local std::int64_t held_bytes = 0;
thread_local std::int64_t peak_bytes = 0;

constexpr std::size_t kPage = 4096;
// Two pages of 2 MiB.
constexpr std::size_t kHugeFrom = std::size_t{4} * 1024 * 1024;

// A hint. A large array is met page by page, which costs the system more than most work on it, and
// is gone through in strides, which then miss the table of pages.
void ask_for_huge_pages(void* block, std::size_t bytes) {
  const int error = errno;
  const std::size_t before = reinterpret_cast<std::uintptr_t>(block) % kPage;
  const std::size_t skipped = before == 0 ? 0 : kPage - before;
  madvise(static_cast<char*>(block) + skipped, (bytes - skipped) / kPage * kPage, MADV_HUGEPAGE);
  errno = error;
}

void note_allocation(void* block) {
  if (block == nullptr) return;
  const std::size_t bytes = malloc_usable_size(block);
  if (bytes >= kHugeFrom) ask_for_huge_pages(block, bytes);
  held_bytes += static_cast<std::int64_t>(bytes);
  peak_bytes = std::max(peak_bytes, held_bytes);
}

void note_release(void* block) {
  if (block != nullptr) held_bytes -= static_cast<std::int64_t>(malloc_usable_size(block));
}

}  // namespace

// glibc's own entry points; replacing malloc is a documented feature of it ("Replacing malloc" in
// its manual), and every function of the family must be replaced together.
extern "C" {

// NOLINTBEGIN(bugprone-reserved-identifier): the names are glibc's
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* block, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);
// NOLINTEND(bugprone-reserved-identifier)

void* malloc(std::size_t size) noexcept {
  void* block = __libc_malloc(size);
  note_allocation(block);
  return block;
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  void* block = __libc_calloc(count, size);
  note_allocation(block);
  return block;
}

void* realloc(void* block, std::size_t size) noexcept {
  note_release(block);
  void* moved = __libc_realloc(block, size);
  // A failed realloc leaves the old block as it was.
  note_allocation(moved != nullptr || size == 0 ? moved : block);
  return moved;
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  void* block = __libc_memalign(alignment, size);
  note_allocation(block);
  return block;
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}

int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  const bool power_of_two = alignment != 0 && (alignment & (alignment - 1)) == 0;
  if (!power_of_two || alignment % sizeof(void*) != 0) return EINVAL;
  void* allocated = memalign(alignment, size);
  if (allocated == nullptr) return ENOMEM;
  *block = allocated;
  return 0;
}

void free(void* block) noexcept {
  note_release(block);
  __libc_free(block);
}

}  // extern "C"

namespace fathom {
namespace {

class MallocMeter final : public MemoryMeter {
 public:
  void start() override {
    base_ = held_bytes;
    peak_bytes = held_bytes;
  }
  std::int64_t stop() override { return peak_bytes - base_; }
  void pause() override { peak_before_ = peak_bytes; }
  void resume() override { peak_bytes = peak_before_; }

 private:
  std::int64_t peak_before_ = 0;
  std::int64_t base_ = 0;
};

}  // namespace

std::unique_ptr<MemoryMeter> make_memory_meter() {
  return std::make_unique<MallocMeter>();
}

}  // namespace fathom

#endif

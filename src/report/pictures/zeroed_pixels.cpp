#include "zeroed_pixels.hpp"

#include <new>
#include <sys/mman.h>
#include <utility>

namespace fathom {

ZeroedPixels::ZeroedPixels(cv::Size size)
    : columns_(static_cast<std::size_t>(size.width)),
      bytes_(columns_ * static_cast<std::size_t>(size.height) * sizeof(float)) {
  if (bytes_ == 0) return;
  void* const memory =
      ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  ::madvise(memory, bytes_, MADV_HUGEPAGE);  // small pages do as well
  first_ = static_cast<float*>(memory);
}

ZeroedPixels::ZeroedPixels(ZeroedPixels&& other) noexcept
    : first_(std::exchange(other.first_, nullptr)),
      columns_(other.columns_),
      bytes_(std::exchange(other.bytes_, 0)) {}

void ZeroedPixels::release() {
  if (first_ != nullptr) ::munmap(first_, bytes_);
  first_ = nullptr;
  bytes_ = 0;
}

}  // namespace fathom

#include "zeroed_pixels.hpp"

#include <new>
#include <sys/mman.h>

namespace fathom {

ZeroedPixels::ZeroedPixels(cv::Size size)
    : columns_(static_cast<std::size_t>(size.width)), pixels_(nullptr, Unmap{0}) {
  const std::size_t bytes = columns_ * static_cast<std::size_t>(size.height) * sizeof(float);
  if (bytes == 0) return;
  void* const memory =
      ::mmap(nullptr, bytes, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
  if (memory == MAP_FAILED) throw std::bad_alloc();
  ::madvise(memory, bytes, MADV_HUGEPAGE);  // small pages do as well
  pixels_ = {static_cast<float*>(memory), Unmap{bytes}};
}

void ZeroedPixels::Unmap::operator()(float* pixels) const {
  ::munmap(pixels, bytes);
}

}  // namespace fathom

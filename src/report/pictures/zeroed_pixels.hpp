#pragma once

#include <cstddef>
#include <memory>

#include <opencv2/core.hpp>

namespace fathom {

/// A float for every pixel of a large picture, all zero at first. Memory comes from the system as
/// it is touched, in large pages where there are some: most of what a map would else cost is its
/// first touch.
class ZeroedPixels {
 public:
  /// Throws std::bad_alloc.
  explicit ZeroedPixels(cv::Size size);

  float* row(int v) { return pixels_.get() + static_cast<std::size_t>(v) * columns_; }

  /// Gives the memory back; no row is left.
  void release() { pixels_.reset(); }

 private:
  struct Unmap {
    std::size_t bytes;
    void operator()(float* pixels) const;
  };

  std::size_t columns_;
  std::unique_ptr<float, Unmap> pixels_;
};

}  // namespace fathom

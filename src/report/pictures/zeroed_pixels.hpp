#pragma once

#include <cstddef>

#include <opencv2/core.hpp>

namespace fathom {

/// A float for every pixel of a large picture, all zero at first. Memory comes from the system as
/// it is touched, in large pages where there are some: most of what a map would else cost is its
/// first touch.
class ZeroedPixels {
 public:
  /// Throws std::bad_alloc.
  explicit ZeroedPixels(cv::Size size);
  ~ZeroedPixels() { release(); }
  ZeroedPixels(ZeroedPixels&& other) noexcept;
  ZeroedPixels& operator=(ZeroedPixels&&) = delete;
  ZeroedPixels(const ZeroedPixels&) = delete;
  ZeroedPixels& operator=(const ZeroedPixels&) = delete;

  float* row(int v) { return first_ + static_cast<std::size_t>(v) * columns_; }

  /// Gives the memory back; no row is left.
  void release();

 private:
  float* first_ = nullptr;
  std::size_t columns_ = 0;
  std::size_t bytes_ = 0;
};

}  // namespace fathom

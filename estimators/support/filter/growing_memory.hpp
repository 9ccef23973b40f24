#pragma once

#include <cstddef>
#include <memory>
#include <vector>

namespace fathom::filter {

/// Memory for numbers that is only ever added to: what was handed out stays where it is, so that a
/// matrix can grow without being copied. Handed out as zeros, on a cache line's boundary.
class GrowingMemory {
 public:
  /// `count` zeros; valid as long as this object.
  double* take(std::size_t count);

  /// Bytes held, those not yet handed out included: at most an eighth more, beyond small sizes.
  std::size_t bytes() const { return bytes_; }

 private:
  struct Free {
    void operator()(double* memory) const;
  };

  std::vector<std::unique_ptr<double, Free>> slabs_;
  double* next_ = nullptr;
  std::size_t left_ = 0;  ///< numbers
  std::size_t bytes_ = 0;
};

}  // namespace fathom::filter

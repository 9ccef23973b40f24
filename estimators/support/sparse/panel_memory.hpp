#pragma once

#include <cstddef>
#include <memory>

#include "fathom/core/workers.hpp"

namespace fathom::sparse {

/// Numbers that nothing has been written to, aligned to a cache line. Where they are many, their
/// pages are asked for at once: a page that is met one at a time costs the system twice as much,
/// and a small graph that is solved once spends a tenth of its time on that. `workers` ask
/// together.
class PanelMemory {
 public:
  explicit PanelMemory(std::size_t count, Workers* workers = nullptr);
  /// Numbers of somebody else, who keeps them.
  PanelMemory(double* lent, std::size_t count) : numbers_(lent), count_(count) {}

  double* data() { return numbers_; }
  const double* data() const { return numbers_; }
  double* begin() { return numbers_; }
  double* end() { return numbers_ + count_; }

 private:
  struct Free {
    void operator()(double* memory) const;
  };
  std::unique_ptr<double, Free> own_;
  double* numbers_ = nullptr;
  std::size_t count_ = 0;
};

}  // namespace fathom::sparse

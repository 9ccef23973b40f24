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

  double* data() { return numbers_.get(); }
  const double* data() const { return numbers_.get(); }
  double* begin() { return numbers_.get(); }
  double* end() { return numbers_.get() + count_; }

 private:
  struct Free {
    void operator()(double* memory) const;
  };
  std::unique_ptr<double, Free> numbers_;
  std::size_t count_ = 0;
};

}  // namespace fathom::sparse

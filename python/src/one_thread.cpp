#include "python/src/one_thread.hpp"

#include <cblas.h>
#include <mutex>
#include <omp.h>

namespace fathom {

namespace {

// Those that live at the same time are pinned as one: the first keeps what there was, and the last
// gives it back.
std::mutex changing;
int living = 0;
int blas_threads = 1;

}  // namespace

OneThread::OneThread() : active_levels_(omp_get_max_active_levels()) {
  const std::lock_guard lock(changing);
  if (living++ == 0) blas_threads = openblas_get_num_threads();
  pin_this_thread();
}

OneThread::~OneThread() {
  const std::lock_guard lock(changing);
  if (--living == 0) openblas_set_num_threads(blas_threads);
  omp_set_max_active_levels(active_levels_);
}

void OneThread::pin_this_thread() {
  omp_set_max_active_levels(0);
  openblas_set_num_threads(1);
}

}  // namespace fathom

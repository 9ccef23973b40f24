#include "python/src/one_thread.hpp"

#include <cblas.h>
#include <omp.h>

namespace fathom {

OneThread::OneThread()
    : blas_threads_(openblas_get_num_threads()), active_levels_(omp_get_max_active_levels()) {
  pin_this_thread();
}

OneThread::~OneThread() {
  openblas_set_num_threads(blas_threads_);
  omp_set_max_active_levels(active_levels_);
}

void OneThread::pin_this_thread() {
  omp_set_max_active_levels(0);
  openblas_set_num_threads(1);
}

}  // namespace fathom

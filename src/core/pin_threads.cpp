#include "fathom/core/pin_threads.hpp"

#include <cblas.h>
#include <omp.h>

// OpenBLAS starts its pool while it is loaded, before `main`, and asks this function of its own for
// what OPENBLAS_NUM_THREADS says. A program's definition goes before the library's. Where another
// OpenBLAS does not ask, its idle pool is started and nothing else is different.
extern "C" int openblas_num_threads_env() {
  return 1;
}

namespace fathom {

// CHOLMOD 5.12 opens an OpenMP team of its own whatever OMP_NUM_THREADS says; without active levels
// it cannot.
void pin_threads() {
  omp_set_max_active_levels(0);
  openblas_set_num_threads(1);
}

}  // namespace fathom

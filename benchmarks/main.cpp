// Threads as in the program `fathom`: one for BLAS and for CHOLMOD's OpenMP, so that costs are
// those of one core; OpenCV has one per core.

#include <cblas.h>
#include <omp.h>

#include <benchmark/benchmark.h>

int main(int argc, char** argv) {
  omp_set_max_active_levels(0);
  openblas_set_num_threads(1);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

// Threads and heap as in the program `fathom`: one thread for BLAS and for CHOLMOD's OpenMP, so
// that costs are those of one core; OpenCV has one per core.

#include <benchmark/benchmark.h>

#include "fathom/core/pin_threads.hpp"
#include "fathom/core/system.hpp"

int main(int argc, char** argv) {
  fathom::pin_threads();
  fathom::keep_free_memory();
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 1;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}

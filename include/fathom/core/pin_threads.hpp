#pragma once

namespace fathom {

/// One thread for BLAS and for CHOLMOD's OpenMP, on the thread that calls and what it calls: cost
/// is compared on one core. A program that links this starts no pool of BLAS at all.
void pin_threads();

}  // namespace fathom

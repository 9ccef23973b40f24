#pragma once

#include <memory>

#include "fathom/harness/replay.hpp"

namespace fathom {

/// Counts what the calling thread allocates and frees through malloc, whoever asks for it: the
/// program interposes the C allocator. Nothing under a sanitizer, which has an allocator of its
/// own.
std::unique_ptr<MemoryMeter> make_memory_meter();

}  // namespace fathom

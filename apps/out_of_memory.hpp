#pragma once

namespace fathom {

/// "fathom: error: out of memory", on standard error.
void print_out_of_memory();

/// From here on the program ends with that line and status 1 where memory runs out, on whatever
/// thread. An exception would not do: a library that it passes through may wait for ever for a
/// thread that was never made, or throw again while it cleans up.
void end_when_out_of_memory();

}  // namespace fathom

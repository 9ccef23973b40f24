#pragma once

#include <filesystem>

namespace fathom {

/// Ends what a process that was killed left of a store: what stands in SQLite's log beside the file
/// comes into it, and no log stays that would be applied to a file that takes its place. A damaged
/// one is left to whoever opens it. Throws InputError where another process is at work on the
/// store, EnvironmentError where it is being read.
void settle_store(const std::filesystem::path& folder);

}  // namespace fathom

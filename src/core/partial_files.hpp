#pragma once

#include <filesystem>

namespace fathom {

/// Removes from a folder what write_file and StagedFolder had begun there for a process of this
/// machine and boot that is dead. What others have begun stays: nobody can tell here whether they
/// live.
void remove_abandoned(const std::filesystem::path& folder);

}  // namespace fathom

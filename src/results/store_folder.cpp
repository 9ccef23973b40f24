#include "fathom/results/store_folder.hpp"

#include <system_error>

#include "fathom/core/folder_claim.hpp"
#include "fathom/core/input_error.hpp"

namespace fathom {
namespace fs = std::filesystem;

namespace {

// A shard has no lock in its folder, but a claim.
const fs::path& unclaimed(const fs::path& folder) {
  FolderClaim::require_free(folder);
  return folder;
}

}  // namespace

StoreFolder::StoreFolder(const fs::path& folder, const StudyDescription& study,
                         const std::string& manifest)
    : folder_(unclaimed(folder)),
      is_new_folder_(!fs::exists(folder)),
      is_new_(!fs::exists(folder / kResultsFile)),
      store_(ResultStore::write(folder, study, manifest)) {}

StoreFolder::~StoreFolder() {
  const bool remove = is_new_ && is_empty();
  store_.reset();
  if (!remove) return;
  std::error_code ignored;
  for (const char* ending : {"", "-wal", "-shm"}) {
    fs::remove(folder_ / (std::string(kResultsFile) + ending), ignored);
  }
  if (is_new_folder_) fs::remove(folder_, ignored);
}

bool StoreFolder::is_empty() const {
  try {
    return store_->runs().empty();
  } catch (const InputError&) {
    return false;
  }
}

}  // namespace fathom

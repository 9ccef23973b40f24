#include "fathom/results/scratch_store.hpp"

#include <algorithm>
#include <system_error>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/hash.hpp"
#include "fathom/core/system.hpp"
#include "result_schema.hpp"
#include "settled_store.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;

fs::path made(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder, error);
  if (error) throw InputError(folder.string(), "cannot be made: " + error.message());
  return folder;
}

// One for each folder that is written into, and user.
fs::path place_for(const fs::path& folder, const fs::path& scratch) {
  const std::string name = fs::absolute(folder).lexically_normal().string();
  return scratch / ("fathom-" + std::to_string(user_number()) + "-" + hash_text(name));
}

// Runs that a store has of a study; nothing where it is none, damaged, or of another study.
std::optional<std::size_t> runs_in(const fs::path& folder, const StudyDescription& study) {
  try {
    const ResultStore store = ResultStore::open(folder / kResultsFile);
    const bool is_same =
        difference(store.study(), study).empty() && data_difference(store.study(), study).empty();
    return is_same ? std::optional(store.runs().size()) : std::nullopt;
  } catch (const EnvironmentError&) {
    throw;  // it may be whole
  } catch (const InputError&) {
    return std::nullopt;
  }
}

void remove_store(const fs::path& folder) {
  std::error_code ignored;
  for (const char* ending : {"", "-wal", "-shm", "-journal"}) {
    fs::remove(folder / (std::string(kResultsFile) + ending), ignored);
  }
}

// A copy of a store that has its place yet to take, or goes.
class PartOfStore {
 public:
  explicit PartOfStore(const fs::path& folder)
      : file_(folder / (std::string(kResultsFile) + ".part")) {
    remove();
  }
  ~PartOfStore() { remove(); }
  PartOfStore(const PartOfStore&) = delete;
  PartOfStore& operator=(const PartOfStore&) = delete;

  const fs::path& file() const { return file_; }

 private:
  void remove() const {
    std::error_code ignored;
    fs::remove(file_, ignored);
    fs::remove(file_.string() + "-journal", ignored);
  }

  fs::path file_;
};

}  // namespace

ScratchStore::ScratchStore(const fs::path& folder, const fs::path& scratch,
                           const StudyDescription& study, const std::string& manifest,
                           ClaimTimes times)
    : folder_(made(folder)), claim_(folder_, times), scratch_(made(place_for(folder, scratch))) {
  try {
    open(study, manifest);
  } catch (const InputError&) {
    std::error_code not_empty;
    fs::remove(scratch_, not_empty);
    throw;
  }
}

void ScratchStore::open(const StudyDescription& study, const std::string& manifest) {
  // Of a process that was killed, here or by a study that was not divided there.
  settle_store(folder_);
  settle_store(scratch_);
  const bool is_published = fs::exists(folder_ / kResultsFile);
  if (is_published) {
    // Says what is wrong with it, by its own name.
    const ResultStore there = ResultStore::open(folder_ / kResultsFile);
    require_same(there.study(), study, folder_ / kResultsFile);
  }
  const auto left = runs_in(scratch_, study);
  if (!left || (is_published && *left < *runs_in(folder_, study))) {
    remove_store(scratch_);
    std::error_code error;
    if (is_published) fs::copy_file(folder_ / kResultsFile, scratch_ / kResultsFile, error);
    if (error)
      throw InputError((scratch_ / kResultsFile).string(), "cannot be written: " + error.message());
  }
  store_.emplace(ResultStore::write(scratch_, study, manifest));
}

ScratchStore::~ScratchStore() {
  bool is_published = false;
  try {
    store_->finish();
    publish();
    is_published = true;
  } catch (const InputError&) {
    // What is on this disk stays; the next session goes on from it.
  }
  store_.reset();
  std::error_code ignored;
  if (is_published) fs::remove_all(scratch_, ignored);
}

void ScratchStore::publish() {
  const auto start = Clock::now();
  claim_.require_held();
  const PartOfStore part(folder_);
  std::error_code error;
  try {
    store_->copy_to(part.file());
    sync_to_disk(part.file());
  } catch (const InputError&) {
    throw InputError(folder_.string(),
                     "cannot be written, or its disk is full; what is done is in " +
                         scratch_.string() + ": make room and run the same command again");
  }
  settle_store(folder_);
  fs::rename(part.file(), folder_ / kResultsFile, error);
  if (error) throw InputError(folder_.string(), "cannot be written: " + error.message());
  published_ = Clock::now();
  took_ = published_ - start;
}

void ScratchStore::publish_when_due() {
  constexpr Clock::duration kPeriod = std::chrono::minutes(1);
  if (Clock::now() - published_ >= std::max(kPeriod, 20 * took_)) publish();
}

}  // namespace fathom

#include <set>
#include <system_error>

#include "fathom/core/files.hpp"
#include "fathom/core/input_error.hpp"
#include "fathom/front_end/registration_store.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

bool has_file(const fs::path& file) {
  std::error_code error;
  return fs::is_regular_file(file, error);
}

}  // namespace

bool has_registrations(const fs::path& folder) {
  return has_file(folder / kRegistrationsFile);
}

bool has_features(const fs::path& folder) {
  return has_file(folder / kFeaturesFile);
}

MergedRegistrations merge_registrations(const std::vector<fs::path>& folders, const fs::path& out) {
  std::vector<fs::path> sources = folders;
  if (has_registrations(out)) sources.push_back(out);
  StagedFolder staged(out);
  MergedRegistrations merged;
  {
    RegistrationStore all(staged.path());
    std::set<fs::path> seen;
    for (const fs::path& folder : sources) {
      if (!seen.insert(fs::weakly_canonical(folder)).second) continue;
      const auto source = RegistrationStore::read_only(folder);
      for (const auto& [key, value] : source->all()) {
        if (const auto there = all.find(key)) {
          if (!(*there == value)) {
            throw InputError(folder.string(),
                             "has another registration of a pair of pictures than the caches "
                             "before it; the same pair gives the same registration: find out "
                             "which one is wrong and make it again");
          }
          ++merged.repeated;
          continue;
        }
        all.put(key, value);
        ++merged.count;
      }
      if (const std::string problem = source->problem(); !problem.empty()) {
        throw InputError(problem);
      }
    }
    all.finish();
    if (const std::string problem = all.problem(); !problem.empty()) throw InputError(problem);
  }
  staged.commit();
  return merged;
}

}  // namespace fathom

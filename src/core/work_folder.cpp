#include "fathom/core/work_folder.hpp"

#include <cerrno>
#include <cstdlib>
#include <system_error>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/system.hpp"

namespace fathom {

namespace fs = std::filesystem;

namespace {

// A process that was killed has left its folder.
void remove_folders_of_the_dead(const fs::path& place, const std::string& opening) {
  std::error_code ignored;
  for (const fs::directory_entry& entry : fs::directory_iterator(place, ignored)) {
    const std::string name = entry.path().filename().string();
    if (!name.starts_with(opening)) continue;
    const std::size_t end = name.rfind('-');
    if (end > opening.size() &&
        is_mark_of_dead(name.substr(opening.size(), end - opening.size()))) {
      fs::remove_all(entry, ignored);
    }
  }
}

}  // namespace

fs::path temporary_place() {
  std::error_code error;
  fs::path place = fs::temp_directory_path(error);
  if (!error) return place;
  const char* const given = std::getenv("TMPDIR");
  throw EnvironmentError(std::string("TMPDIR=") + (given == nullptr ? "" : given),
                         "is no folder for the program's files: " + error.message());
}

WorkFolder::WorkFolder(const std::string& name) {
  const fs::path place = temporary_place();
  const std::string opening = name + "-";
  remove_folders_of_the_dead(place, opening);
  path_ = place / (opening + process_mark() + "-" + unique_word().substr(0, 8));
  std::error_code error;
  const bool is_new = fs::create_directory(path_, error);
  if (error) throw EnvironmentError(path_.string(), "cannot be made: " + error.message());
  if (!is_new) throw EnvironmentError(path_.string(), "cannot be made", EEXIST);
}

WorkFolder::~WorkFolder() {
  std::error_code ignored;
  fs::remove_all(path_, ignored);
}

}  // namespace fathom

#include "fathom/core/file_lock.hpp"

#include <cerrno>
#include <fcntl.h>
#include <string>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include "fathom/core/environment_error.hpp"

namespace fathom {

FileLock::FileLock(const std::filesystem::path& file, const std::string& busy) : file_(file) {
  for (;;) {
    descriptor_ = ::open(file.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor_ < 0) throw EnvironmentError(file.string(), "cannot be written", errno);
    const bool is_locked = ::flock(descriptor_, LOCK_EX | LOCK_NB) == 0;
    if (is_locked && is_at_its_place()) return;
    const int error = errno;
    ::close(descriptor_);
    if (!is_locked && error == EWOULDBLOCK) throw InputError(busy);
    if (!is_locked) throw EnvironmentError(file.string(), "cannot be locked", error);
    // The holder before removed it after it was opened here: whoever comes now finds another.
  }
}

bool FileLock::is_at_its_place() const {
  struct stat held {};
  struct stat found {};
  return ::fstat(descriptor_, &held) == 0 && ::stat(file_.c_str(), &found) == 0 &&
         held.st_ino == found.st_ino && held.st_dev == found.st_dev;
}

bool FileLock::is_held(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool is_free = ::flock(descriptor, LOCK_SH | LOCK_NB) == 0;
  ::close(descriptor);
  return !is_free;
}

FileLock::~FileLock() {
  if (is_at_its_place()) ::unlink(file_.c_str());
  ::close(descriptor_);
}

}  // namespace fathom

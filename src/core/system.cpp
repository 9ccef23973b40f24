#include "fathom/core/system.hpp"

#include <algorithm>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <fstream>
#include <malloc.h>
#include <sys/resource.h>
#include <unistd.h>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/hash.hpp"
#include "fathom/core/text.hpp"
#include "time_value.hpp"

namespace fathom {
namespace {

std::string first_line(const char* path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

rusage usage_of(__rusage_who who) {
  rusage used{};
  ::getrusage(who, &used);
  return used;
}

}  // namespace

std::string host_name() {
  char name[256] = {};
  return ::gethostname(name, sizeof name - 1) == 0 && name[0] != '\0' ? name : "unknown";
}

long process_number() {
  return ::getpid();
}

std::string process_space() {
  // Once: later there may be no descriptor left to read it by.
  static const std::string space = [] {
    char link[128] = {};
    const auto length = ::readlink("/proc/self/ns/pid", link, sizeof link - 1);
    return first_line("/proc/sys/kernel/random/boot_id") + (length > 0 ? link : "");
  }();
  return space;
}

bool is_dead_process(long number) {
  return ::kill(static_cast<pid_t>(number), 0) != 0 && errno == ESRCH;
}

std::string process_mark() {
  return std::to_string(process_number()) + "-" + hash_text(process_space());
}

bool is_mark_of_dead(std::string_view mark) {
  const std::size_t end = mark.find('-');
  if (end == std::string_view::npos || mark.substr(end + 1) != hash_text(process_space())) {
    return false;
  }
  const auto number = parse_integer(mark.substr(0, end));
  return number && *number > 0 && is_dead_process(static_cast<long>(*number));
}

unsigned user_number() {
  return ::getuid();
}

std::string unique_word() {
  return first_line("/proc/sys/kernel/random/uuid");
}

double processor_seconds() {
  double sum = 0.0;
  for (const __rusage_who who : {RUSAGE_SELF, RUSAGE_CHILDREN}) {
    const rusage used = usage_of(who);
    sum += seconds(used.ru_utime) + seconds(used.ru_stime);
  }
  return sum;
}

double peak_memory_mib() {
  const auto most = std::max(usage_of(RUSAGE_SELF).ru_maxrss, usage_of(RUSAGE_CHILDREN).ru_maxrss);
  return static_cast<double>(most) / 1024.0;
}

void sync_to_disk(const std::filesystem::path& file) {
  const int descriptor = ::open(file.c_str(), O_RDONLY | O_CLOEXEC);
  // Some file systems have nothing to wait for, of a folder above all.
  const bool is_synced =
      descriptor >= 0 && (::fsync(descriptor) == 0 || errno == EINVAL || errno == ENOTSUP);
  const int error = errno;
  if (descriptor >= 0) ::close(descriptor);
  if (!is_synced) throw EnvironmentError(file.string(), "cannot be written", error);
}

void keep_free_memory() {
#ifdef __GLIBC__
  // What is larger is mapped alone, and goes back at once.
  mallopt(M_MMAP_THRESHOLD, 32 << 20);
  mallopt(M_TRIM_THRESHOLD, 256 << 20);
#endif
}

void return_free_memory() {
#ifdef __GLIBC__
  malloc_trim(0);
#endif
}

}  // namespace fathom

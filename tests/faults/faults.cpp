// Loaded into the program before all other libraries (LD_PRELOAD): a machine at fault.
//
// FATHOM_FAULT_CALL=NAME: write, pwrite64, fsync, rename, renamed, open, mkdir, mmap, fork or
// ftruncate; what does the same by another name counts as that. `renamed` is a rename that was done
// and is told as failed, as a network file system does whose answer got lost. FATHOM_FAULT_AT=K:
// from its K-th call on, counted from 1 ... FATHOM_FAULT_COUNT=N: ... N of them (default: 1) ...
// FATHOM_FAULT_ERROR=NUMBER: ... fail with this errno.
// FATHOM_FAULT_PATH=TEXT: of calls with a file, those alone whose path has this in it.
// FATHOM_FAULT_MET=FILE: is made when the first of them fails.
// FATHOM_FAULT_CLOCK=SECONDS: apart from all this, added to the time of day.
//
// Standard streams, pipes, /proc, /sys and /dev have no faults, nor have other programs than
// `fathom`. A process has the count of the one that forked it.

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <dlfcn.h>
#include <fcntl.h>
#include <spawn.h>
#include <string_view>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/syscall.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

long number(const char* name, long otherwise) {
  const char* const value = std::getenv(name);
  return value == nullptr ? otherwise : std::atol(value);
}

const char* text(const char* name) {
  const char* const value = std::getenv(name);
  return value == nullptr ? "" : value;
}

void note_met() {
  const char* const path = text("FATHOM_FAULT_MET");
  if (*path != '\0') ::syscall(SYS_close, ::syscall(SYS_open, path, O_WRONLY | O_CREAT, 0600));
}

// Whether this call is to fail; its errno is set then.
bool fails(const char* call, std::string_view path = {}) {
  static std::atomic<long> calls = 0;
  if (std::strcmp(call, text("FATHOM_FAULT_CALL")) != 0) return false;
  if (std::strcmp(::program_invocation_short_name, "fathom") != 0) return false;
  for (const char* const kind : {"/proc/", "/sys/", "/dev/", "pipe:", "socket:"}) {
    if (path.starts_with(kind)) return false;
  }
  if (path.find(text("FATHOM_FAULT_PATH")) == std::string_view::npos) return false;
  const long count = ++calls;
  const long first = number("FATHOM_FAULT_AT", 1);
  if (count < first || count >= first + number("FATHOM_FAULT_COUNT", 1)) return false;
  note_met();
  errno = static_cast<int>(number("FATHOM_FAULT_ERROR", ENOSPC));
  return true;
}

// Of an open file, by what the system calls it.
bool fails_at(const char* call, int file) {
  if (file <= STDERR_FILENO) return false;
  char link[64];
  std::snprintf(link, sizeof link, "/proc/self/fd/%d", file);
  char path[4096];
  const ssize_t length = ::readlink(link, path, sizeof path);
  return length > 0 && fails(call, {path, static_cast<std::size_t>(length)});
}

template <class Function>
Function* next(const char* name) {
  return reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

unsigned mode_of(int flags, va_list arguments) {
  return (flags & (O_CREAT | O_TMPFILE)) != 0 ? va_arg(arguments, unsigned) : 0;
}

}  // namespace

// A function of the C library that fails in place of being called where the condition holds.
#define FATHOM_FAULTS(result, name, parameters, condition, failure, arguments) \
  result name parameters {                                                     \
    static auto* const real = next<result parameters>(#name);                  \
    return (condition) ? (failure) : real arguments;                           \
  }

extern "C" {

FATHOM_FAULTS(ssize_t, write, (int file, const void* bytes, size_t size), fails_at("write", file),
              -1, (file, bytes, size))
FATHOM_FAULTS(ssize_t, writev, (int file, const iovec* parts, int count), fails_at("write", file),
              -1, (file, parts, count))
FATHOM_FAULTS(ssize_t, pwrite, (int file, const void* bytes, size_t size, off_t at),
              fails_at("pwrite64", file), -1, (file, bytes, size, at))
FATHOM_FAULTS(ssize_t, pwrite64, (int file, const void* bytes, size_t size, off64_t at),
              fails_at("pwrite64", file), -1, (file, bytes, size, at))
FATHOM_FAULTS(int, fsync, (int file), fails_at("fsync", file), -1, (file))
FATHOM_FAULTS(int, fdatasync, (int file), fails_at("fsync", file), -1, (file))
FATHOM_FAULTS(int, ftruncate, (int file, off_t size), fails_at("ftruncate", file), -1, (file, size))
FATHOM_FAULTS(int, ftruncate64, (int file, off64_t size), fails_at("ftruncate", file), -1,
              (file, size))
FATHOM_FAULTS(int, mkdir, (const char* path, mode_t mode), fails("mkdir", path), -1, (path, mode))
FATHOM_FAULTS(FILE*, fopen, (const char* path, const char* mode), fails("open", path), nullptr,
              (path, mode))
FATHOM_FAULTS(FILE*, fopen64, (const char* path, const char* mode), fails("open", path), nullptr,
              (path, mode))
FATHOM_FAULTS(void*, mmap,
              (void* at, size_t size, int protection, int flags, int file, off_t offset),
              fails("mmap"), MAP_FAILED, (at, size, protection, flags, file, offset))
FATHOM_FAULTS(void*, mmap64,
              (void* at, size_t size, int protection, int flags, int file, off64_t offset),
              fails("mmap"), MAP_FAILED, (at, size, protection, flags, file, offset))
FATHOM_FAULTS(pid_t, fork, (), fails("fork"), -1, ())
FATHOM_FAULTS(int, posix_spawn,
              (pid_t * id, const char* path, const posix_spawn_file_actions_t* actions,
               const posix_spawnattr_t* attributes, char* const* words, char* const* environment),
              fails("fork"), errno, (id, path, actions, attributes, words, environment))

int rename(const char* from, const char* to) {
  static auto* const real = next<int(const char*, const char*)>("rename");
  if (fails("rename", to)) return -1;
  const int result = real(from, to);
  return result == 0 && fails("renamed", to) ? -1 : result;
}

int clock_gettime(clockid_t clock, timespec* now) {
  static auto* const real = next<int(clockid_t, timespec*)>("clock_gettime");
  const int result = real(clock, now);
  if (clock == CLOCK_REALTIME) now->tv_sec += number("FATHOM_FAULT_CLOCK", 0);
  return result;
}

time_t time(time_t* now) {
  timespec at{};
  ::clock_gettime(CLOCK_REALTIME, &at);
  if (now != nullptr) *now = at.tv_sec;
  return at.tv_sec;
}

int open(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open");
  va_list more;
  va_start(more, flags);
  const unsigned mode = mode_of(flags, more);
  va_end(more);
  return fails("open", path) ? -1 : real(path, flags, mode);
}

int open64(const char* path, int flags, ...) {
  static auto* const real = next<int(const char*, int, ...)>("open64");
  va_list more;
  va_start(more, flags);
  const unsigned mode = mode_of(flags, more);
  va_end(more);
  return fails("open", path) ? -1 : real(path, flags, mode);
}

int openat(int folder, const char* path, int flags, ...) {
  static auto* const real = next<int(int, const char*, int, ...)>("openat");
  va_list more;
  va_start(more, flags);
  const unsigned mode = mode_of(flags, more);
  va_end(more);
  return fails("open", path) ? -1 : real(folder, path, flags, mode);
}

int openat64(int folder, const char* path, int flags, ...) {
  static auto* const real = next<int(int, const char*, int, ...)>("openat64");
  va_list more;
  va_start(more, flags);
  const unsigned mode = mode_of(flags, more);
  va_end(more);
  return fails("open", path) ? -1 : real(folder, path, flags, mode);
}

}  // extern "C"

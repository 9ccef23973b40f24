// Loaded into the program before all other libraries (LD_PRELOAD).
//
// FATHOM_THREAD_COUNT=FILE: one byte is added to the file for every thread that is started. It is
// made at once, so that it is there, and empty, where none is.
// FATHOM_KILL_AT_WRITE=N: the program is killed when it is about to write to a database for the
// N-th time.
// FATHOM_DISK_BYTES=N: files take so many bytes in all, then the disk is full.

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
#include <sys/uio.h>
#include <unistd.h>

namespace {

int open_count() {
  const char* path = std::getenv("FATHOM_THREAD_COUNT");
  return path == nullptr ? -1 : ::open(path, O_WRONLY | O_CREAT | O_APPEND, 0600);
}

[[gnu::constructor]] void make_count() {
  ::close(open_count());
}

// Sets `next` to the function of the library after this one.
template <class Function>
void find_next(Function*& next, const char* name) {
  next = reinterpret_cast<Function*>(::dlsym(RTLD_NEXT, name));
}

void count_write() {
  static std::atomic<int> writes = 0;
  static const char* const at = std::getenv("FATHOM_KILL_AT_WRITE");
  if (at != nullptr && ++writes == std::atoi(at)) ::raise(SIGKILL);
}

// Whether a file takes so many bytes more; standard streams are none.
bool has_room(int file, size_t bytes) {
  static std::atomic<long long> written = 0;
  static const char* const room = std::getenv("FATHOM_DISK_BYTES");
  if (room == nullptr || file <= STDERR_FILENO) return true;
  if ((written += static_cast<long long>(bytes)) <= std::atoll(room)) return true;
  errno = ENOSPC;
  return false;
}

}  // namespace

extern "C" {

ssize_t write(int file, const void* bytes, size_t size) {
  static decltype(::write)* next = nullptr;
  find_next(next, "write");
  return has_room(file, size) ? next(file, bytes, size) : -1;
}

ssize_t writev(int file, const iovec* parts, int count) {
  static decltype(::writev)* next = nullptr;
  find_next(next, "writev");
  size_t size = 0;
  for (int i = 0; i < count; ++i) size += parts[i].iov_len;
  return has_room(file, size) ? next(file, parts, count) : -1;
}

int pthread_create(pthread_t* thread, const pthread_attr_t* attributes, void* (*start)(void*),
                   void* argument) {
  static decltype(::pthread_create)* next = nullptr;
  find_next(next, "pthread_create");
  const int count = open_count();
  if (count >= 0 && ::write(count, "+", 1) != 1) std::abort();
  ::close(count);
  return next(thread, attributes, start, argument);
}

// SQLite writes with this one alone.
ssize_t pwrite64(int file, const void* bytes, size_t size, off64_t offset) {
  static decltype(::pwrite64)* next = nullptr;
  find_next(next, "pwrite64");
  count_write();
  return next(file, bytes, size, offset);
}

}  // extern "C"

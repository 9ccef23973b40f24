// Loaded into the program before all other libraries (LD_PRELOAD).
//
// FATHOM_THREAD_COUNT=FILE: one byte is added to the file for every thread that is started. It is
// made at once, so that it is there, and empty, where none is.
// FATHOM_KILL_AT_WRITE=N: the program is killed when it is about to write to a database for the
// N-th time.

#include <atomic>
#include <csignal>
#include <cstdlib>
#include <dlfcn.h>
#include <fcntl.h>
#include <pthread.h>
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

}  // namespace

extern "C" {

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

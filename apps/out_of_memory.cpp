#include "apps/out_of_memory.hpp"

#include <atomic>
#include <cstdio>
#include <new>
#include <unistd.h>

#include <opencv2/core.hpp>

#include "apps/command.hpp"

namespace fathom {
namespace {

[[noreturn]] void end_out_of_memory() {
  // Of several threads that find none, one says so.
  static std::atomic_flag has_begun = ATOMIC_FLAG_INIT;
  while (has_begun.test_and_set()) ::pause();
  print_out_of_memory();
  // Destructors would want the other threads' work.
  ::_exit(kFailed);
}

// OpenCV allocates pictures by malloc and calls this before it throws.
int end_at_error_of_opencv(int status, const char* /*function*/, const char* /*message*/,
                           const char* /*file*/, int /*line*/, void* /*data*/) {
  if (status == cv::Error::StsNoMem) end_out_of_memory();
  return 0;
}

}  // namespace

void print_out_of_memory() {
  std::fputs("fathom: error: out of memory\n", stderr);
}

void end_when_out_of_memory() {
  std::set_new_handler(end_out_of_memory);
  cv::redirectError(end_at_error_of_opencv);
}

}  // namespace fathom

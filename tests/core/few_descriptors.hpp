#pragma once

#include <sys/resource.h>

namespace fathom::test {

/// As long as it lives this process may open no file more, or none of a number from `most` on. It
/// ends before an exception is looked at: the undefined-behaviour sanitizer asks the system by a
/// pipe what memory may be read.
class FewDescriptors {
 public:
  explicit FewDescriptors(rlim_t most = 0) {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit few{most, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &few);
  }
  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit before_{};
};

}  // namespace fathom::test

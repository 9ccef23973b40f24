#pragma once

#include <sys/resource.h>

namespace fathom::test {

/// As long as it lives this process may open no file more. It ends before an exception is looked
/// at: the undefined-behaviour sanitizer asks the system by a pipe what memory may be read.
class FewDescriptors {
 public:
  FewDescriptors() {
    ::getrlimit(RLIMIT_NOFILE, &before_);
    const rlimit none{0, before_.rlim_max};
    ::setrlimit(RLIMIT_NOFILE, &none);
  }
  ~FewDescriptors() { ::setrlimit(RLIMIT_NOFILE, &before_); }
  FewDescriptors(const FewDescriptors&) = delete;
  FewDescriptors& operator=(const FewDescriptors&) = delete;

 private:
  rlimit before_{};
};

}  // namespace fathom::test

#pragma once

#include <unistd.h>

#include <gtest/gtest.h>

#include "fathom/core/features.hpp"

/// Skips the test where this build lacks the feature, saying what makes it run.
#define FATHOM_REQUIRE_FEATURE(name) \
  if (!::fathom::feature(name).is_built) GTEST_SKIP() << ::fathom::refusal_without(name)

/// Skips a test of what a user may not do.
#define FATHOM_REQUIRE_NO_ROOT() \
  if (::geteuid() == 0) GTEST_SKIP() << "root may write anywhere; run scripts/test.sh as a user"

namespace fathom::test {

inline constexpr const char* kNoRos1Writer =
    "built without librosbag or the message classes of ROS; 'scripts/build.sh import' installs "
    "them "
    "and builds again";

}  // namespace fathom::test

#pragma once

#include <filesystem>
#include <string>

#include <gtest/gtest.h>

namespace fathom::test {

inline std::filesystem::path data_path(const std::string& relative) {
  return std::filesystem::path(FATHOM_TEST_DATA) / relative;
}

}  // namespace fathom::test

/// Skips the test, saying why, where a file of the development data is not there.
#define FATHOM_REQUIRE_DATA(relative)                              \
  if (!std::filesystem::exists(fathom::test::data_path(relative))) \
  GTEST_SKIP() << fathom::test::data_path(relative).string() << " is not there"

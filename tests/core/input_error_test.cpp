#include "fathom/core/input_error.hpp"

#include <gtest/gtest.h>

namespace fathom {
namespace {

TEST(InputError, IsOneLineWhateverAFileOrALibrarySays) {
  EXPECT_STREQ(InputError("no such table\n: runs\r\n").what(), "no such table : runs  ");
  EXPECT_STREQ(InputError("a\nb.yaml", 3, "what\nelse").what(), "a b.yaml:3: what else");
  EXPECT_STREQ(InputError("a\nb.yaml", "what\nelse").what(), "a b.yaml: what else");
}

}  // namespace
}  // namespace fathom

#include "fathom/core/forked_child.hpp"

#include <string>

#include <gmock/gmock.h>

#include "core/few_descriptors.hpp"
#include "fathom/core/environment_error.hpp"

namespace fathom {
namespace {

using ::testing::HasSubstr;

constexpr ChildLimits kLimits{60.0, std::int64_t{1} << 32};

std::string environment_fault_of(const std::function<void(const MessagePipe&)>& action,
                                 std::string* heard = nullptr) {
  try {
    run_child(action, kLimits, [&](char, const std::string& text) {
      if (heard != nullptr) *heard += text;
    });
  } catch (const EnvironmentError& error) {
    return error.what();
  }
  return "none";
}

TEST(ForkedChild, SaysWhatItIsToSay) {
  std::string heard;
  const auto speak = [](const MessagePipe& parent) { parent.send('a', "well"); };
  EXPECT_EQ(environment_fault_of(speak, &heard), "none");
  EXPECT_EQ(heard, "well");
}

TEST(ForkedChild, AFaultOfItsEnvironmentIsThrownByItsParent) {
  std::string heard;
  const auto find_no_room = [](const MessagePipe& parent) {
    parent.send('a', "well");
    throw EnvironmentError("disk", "cannot be written", ENOSPC);
  };
  EXPECT_EQ(environment_fault_of(find_no_room, &heard),
            "disk: cannot be written: No space left on device");
  EXPECT_EQ(heard, "well");
}

TEST(ForkedChild, WithoutDescriptorsItIsNotBegun) {
  std::string said;
  try {
    const test::FewDescriptors none_left;
    run_child([](const MessagePipe&) {}, kLimits, [](char, const std::string&) {});
  } catch (const EnvironmentError& error) {
    said = error.what();
  }
  EXPECT_THAT(said, HasSubstr("Too many open files"));
}

}  // namespace
}  // namespace fathom

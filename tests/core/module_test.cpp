#include "fathom/core/module.hpp"

#include <dlfcn.h>
#include <fstream>

#include <gmock/gmock.h>

#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// The C library, whatever a sanitizer puts before it.
std::filesystem::path some_library() {
  Dl_info found{};
  return ::dladdr(::dlsym(RTLD_NEXT, "malloc"), &found) != 0 ? found.dli_fname : "";
}

TEST(Module, GivesItsSymbol) {
  const LoadedModule module = load_module({some_library(), "none"}, "malloc");
  EXPECT_NE(module.symbol, nullptr);
  EXPECT_FALSE(module.is_missing);
  EXPECT_THAT(module.problem, IsEmpty());
}

TEST(Module, BesideTheProgramGoesFirstEvenIfItIsBroken) {
  const test::TemporaryFolder folder;
  const std::filesystem::path installed = folder / some_library().filename();
  std::ofstream(installed) << "no library";
  const LoadedModule module = load_module({some_library(), folder.path()}, "malloc");
  EXPECT_EQ(module.symbol, nullptr);
  EXPECT_THAT(module.problem, HasSubstr(installed.string()));
}

TEST(Module, SaysThatItIsMissing) {
  const LoadedModule module = load_module({"/nowhere/fathom_none.so", "none"}, "malloc");
  EXPECT_EQ(module.symbol, nullptr);
  EXPECT_TRUE(module.is_missing);
  EXPECT_EQ(module.problem, "/nowhere/fathom_none.so is missing");
}

TEST(Module, SaysWhyItCannotBeLoaded) {
  const test::TemporaryFolder folder;
  std::ofstream(folder / "fathom_text.so") << "no library";
  const LoadedModule text = load_module({folder / "fathom_text.so", "none"}, "malloc");
  EXPECT_EQ(text.symbol, nullptr);
  EXPECT_FALSE(text.is_missing);
  EXPECT_THAT(text.problem, HasSubstr("fathom_text.so"));
  const LoadedModule other = load_module({some_library(), "none"}, "fathom_no_such_symbol");
  EXPECT_EQ(other.symbol, nullptr);
  EXPECT_THAT(other.problem, HasSubstr("fathom_no_such_symbol"));
}

}  // namespace
}  // namespace fathom

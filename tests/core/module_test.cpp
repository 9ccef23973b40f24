#include "fathom/core/module.hpp"

#include <dlfcn.h>
#include <fstream>

#include <gmock/gmock.h>

#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;

// One that every program of these tests has.
std::filesystem::path some_library() {
  Dl_info found{};
  return ::dladdr(reinterpret_cast<void*>(&::dlopen), &found) != 0 ? found.dli_fname : "";
}

TEST(Module, GivesItsSymbol) {
  const LoadedModule module = load_module({some_library(), "none"}, "malloc");
  EXPECT_NE(module.symbol, nullptr);
  EXPECT_FALSE(module.is_missing);
  EXPECT_THAT(module.problem, IsEmpty());
}

TEST(Module, BesideTheProgramGoesFirst) {
  const test::TemporaryFolder folder;
  const std::filesystem::path built = folder / some_library().filename();
  std::ofstream(built) << "no library";
  const LoadedModule module = load_module({built, some_library().parent_path()}, "malloc");
  EXPECT_NE(module.symbol, nullptr);
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

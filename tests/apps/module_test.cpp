// A program whose module of picture codecs is broken where it is installed.

#include <filesystem>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

using ::testing::HasSubstr;

class BrokenCodecs : public CommandLine {
 protected:
  void SetUp() override {
    fs::create_directories(path("prefix/bin"));
    fs::copy_file(FATHOM_BINARY, path("prefix/bin/fathom"));
    const fs::path module = "prefix/bin" / fs::path(FATHOM_MODULE_INSTALLED) / "fathom_codecs.so";
    const std::string installed = module.lexically_normal().string();
    fs::create_directories(path(installed).parent_path());
    write(installed, "no library");
    surroundings_.program = path("prefix/bin/fathom");
  }
};

TEST_F(BrokenCodecs, AreNamedWhereAPictureIsRead) {
  write("a.png", "any");
  const std::string said =
      refusal({"register", "a.png", "a.png", "--altitude-a", "2", "--altitude-b", "2"});
  EXPECT_THAT(said, HasSubstr("pictures are neither read nor written: "));
  EXPECT_THAT(said, HasSubstr("fathom_codecs.so"));
  EXPECT_THAT(said, HasSubstr("'scripts/build.sh' or the package fathom puts it right"));
}

TEST_F(BrokenCodecs, AreNotMissedWhereNoneIs) {
  fathom_done({"list", "metrics"});
}

}  // namespace
}  // namespace fathom::test

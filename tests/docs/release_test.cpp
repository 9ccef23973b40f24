// What a public project says of itself: the version, stated in CMakeLists.txt, and the licence.

#include <fstream>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>

#include "fathom/core/version.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

std::string content_of(const std::string& file) {
  std::ostringstream text;
  text << std::ifstream(std::string(FATHOM_SOURCE_DIR "/") + file).rdbuf();
  return text.str();
}

std::string found_in(const std::string& file, const std::string& pattern) {
  const std::string text = content_of(file);
  std::smatch found;
  return std::regex_search(text, found, std::regex(pattern)) ? found[1].str() : "";
}

TEST(Release, TheVersionIsThatOfTheBuildEverywhere) {
  const std::string heading = R"(\n## \[(\d[\d.]*)\] - )";
  EXPECT_EQ(found_in("CHANGELOG.md", heading), version());
  EXPECT_EQ(found_in("CITATION.cff", R"(\nversion: (\S+)\n)"), version());
  const std::string minor = version().substr(0, version().rfind('.'));
  EXPECT_EQ(found_in("docs/library.md", R"(find_package\(fathom (\S+) REQUIRED\))"), minor);
}

TEST(Release, TheChangelogAndTheCitationAreOfOneDay) {
  EXPECT_EQ(found_in("CITATION.cff", R"(\ndate-released: (\S+)\n)"),
            found_in("CHANGELOG.md", R"(\n## \[\d[\d.]*\] - (\S+)\n)"));
}

TEST(Release, TheLicenceIsTheSameEverywhere) {
  EXPECT_THAT(content_of("LICENSE"), HasSubstr("BSD 3-Clause License"));
  for (const char* file : {"README.md", "CONTRIBUTING.md", "CITATION.cff", "docs/library.md",
                           "cmake/package/copyright.in"}) {
    EXPECT_THAT(content_of(file), HasSubstr("BSD-3-Clause")) << file;
  }
}

}  // namespace
}  // namespace fathom::test

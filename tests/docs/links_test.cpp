// README and docs/: every link leads somewhere, every page is found from the site.

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <regex>
#include <sstream>

#include <gmock/gmock.h>

#include "docs/markdown.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::Contains;
using ::testing::HasSubstr;

const fs::path kTop = FATHOM_SOURCE_DIR;

std::vector<fs::path> pages() {
  std::vector<fs::path> all{kTop / "README.md", kTop / "CONTRIBUTING.md"};
  for (const auto& entry : fs::recursive_directory_iterator(kTop / "docs")) {
    if (entry.path().extension() == ".md") all.push_back(entry.path());
  }
  return all;
}

std::string text_of(const fs::path& path) {
  std::ostringstream text;
  text << std::ifstream(path).rdbuf();
  return text.str();
}

TEST(Docs, EveryLinkLeadsToAFileAndItsAnchorToAHeading) {
  std::size_t seen = 0;
  for (const fs::path& page : pages()) {
    for (const std::string& link : read_markdown(page).links) {
      if (link.find("://") != std::string::npos) continue;
      ++seen;
      const std::size_t hash = std::min(link.find('#'), link.size());
      const fs::path target = hash == 0 ? page : page.parent_path() / link.substr(0, hash);
      ASSERT_TRUE(fs::exists(target)) << page << ": " << link;
      if (hash < link.size()) {
        EXPECT_THAT(read_markdown(target).anchors, Contains(link.substr(hash + 1)))
            << page << ": " << link;
      }
    }
  }
  EXPECT_GT(seen, 60u);
}

TEST(Docs, EveryPageIsInTheNavigationAndInTheIndex) {
  const std::string navigation = text_of(kTop / "docs/site/mkdocs.yml");
  const std::vector<std::string> index = read_markdown(kTop / "docs/index.md").links;
  for (const fs::path& page : pages()) {
    const std::string name = page.lexically_relative(kTop / "docs").generic_string();
    if (name.starts_with("../") || name == "index.md") continue;
    EXPECT_THAT(navigation, HasSubstr(": " + name + "\n"));
    EXPECT_THAT(index, Contains(name));
  }
}

// `Class::member` and `function` in the tables of the page.
TEST(Docs, WhatThePaperIsMappedToIsInTheSources) {
  std::string sources;
  for (const char* folder : {"include", "src", "estimators"}) {
    for (const auto& entry : fs::recursive_directory_iterator(kTop / folder)) {
      const auto ending = entry.path().extension();
      if (ending == ".hpp" || ending == ".cpp") sources += text_of(entry.path());
    }
  }
  const std::string page = text_of(kTop / "docs/paper_to_code.md");
  const std::regex quoted(R"(`(?:(\w+)::)?([a-zA-Z]\w*)`)");
  std::size_t seen = 0;
  for (std::sregex_iterator found(page.begin(), page.end(), quoted), end; found != end; ++found) {
    EXPECT_THAT(sources, HasSubstr((*found)[1].str())) << found->str();
    EXPECT_THAT(sources, HasSubstr((*found)[2].str())) << found->str();
    ++seen;
  }
  EXPECT_GT(seen, 20u);
}

TEST(Docs, TheReadmeIsShort) {
  EXPECT_LE(fs::file_size(kTop / "README.md"), 8000u);
}

}  // namespace
}  // namespace fathom::test

#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace fathom::test {

/// A fenced block: "```cpp title="FILE"" and the lines up to the closing fence.
struct CodeBlock {
  std::string language;
  std::string title;    ///< empty where there is none
  std::string section;  ///< the heading above
  std::vector<std::string> lines;
};

/// What the tests need of a page.
struct MarkdownPage {
  std::vector<std::string> links;    ///< targets of [text](target) outside code
  std::vector<std::string> anchors;  ///< of its headings, as GitHub and the site name them
  std::vector<CodeBlock> blocks;
};

/// Reads a page. Throws std::runtime_error where it cannot be read or a fence is left open.
MarkdownPage read_markdown(const std::filesystem::path& path);

}  // namespace fathom::test

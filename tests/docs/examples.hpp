#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "docs/markdown.hpp"

namespace fathom::test {

/// What an example of a page does to one file.
struct FileChange {
  std::string section;  ///< heading that it stands under
  std::string file;     ///< from the top of the repository
  bool is_new = false;
  int lines_added = 0;
};

/// Applies the titled blocks of a page to the tree at `top`: a block of `diff` changes its file,
/// hunks being parted by `@@`; any other is a new file. Throws std::runtime_error where a new file
/// exists, or where the lines that a hunk asks for are not in its file exactly once.
std::vector<FileChange> apply_examples(const MarkdownPage& page, const std::filesystem::path& top);

}  // namespace fathom::test

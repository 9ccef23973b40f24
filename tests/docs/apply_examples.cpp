// apply_examples PAGE SOURCE FOLDER [SECTION …]: copies the sources of Fathom, without tests, to
// FOLDER, which must not be there, and applies the examples of the page, but for these sections.
// Prints the C++ files that differ.

#include <algorithm>
#include <cstdio>
#include <exception>

#include "docs/examples.hpp"

int main(int count, char** arguments) {
  namespace fs = std::filesystem;
  if (count < 4) return 2;
  try {
    const fs::path source = arguments[2];
    const fs::path folder = arguments[3];
    fs::create_directories(folder);
    for (const char* name :
         {"include", "src", "estimators", "adapters", "apps", "python", "cmake"}) {
      fs::copy(source / name, folder / name, fs::copy_options::recursive);
    }
    fs::create_directories(folder / "scripts");
    for (const char* name : {"CMakeLists.txt", "LICENSE", "scripts/setup.sh"}) {
      fs::copy_file(source / name, folder / name);
    }
    fathom::test::MarkdownPage page = fathom::test::read_markdown(arguments[1]);
    const std::vector<std::string> left_out(arguments + 4, arguments + count);
    std::erase_if(page.blocks, [&](const fathom::test::CodeBlock& block) {
      return std::ranges::find(left_out, block.section) != left_out.end();
    });
    const auto changes = fathom::test::apply_examples(page, folder);
    for (const fathom::test::FileChange& change : changes) {
      if (!change.file.ends_with(".cpp")) continue;
      std::printf("%s\n", (folder / change.file).c_str());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "apply_examples: %s\n", error.what());
    return 1;
  }
}

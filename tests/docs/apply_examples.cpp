// apply_examples PAGE SOURCE FOLDER: copies the sources of Fathom, without tests, to FOLDER, which
// must not be there, and applies the examples of the page. Prints the C++ files that differ.

#include <cstdio>
#include <exception>

#include "docs/examples.hpp"

int main(int count, char** arguments) {
  namespace fs = std::filesystem;
  if (count != 4) return 2;
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
    const auto changes =
        fathom::test::apply_examples(fathom::test::read_markdown(arguments[1]), folder);
    for (const fathom::test::FileChange& change : changes) {
      if (!change.file.ends_with(".cpp")) continue;
      std::printf("%s\n", (folder / change.file).c_str());
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "apply_examples: %s\n", error.what());
    return 1;
  }
}

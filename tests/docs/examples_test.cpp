// How many places of the sources each example of docs/extending.md touches.

#include "docs/examples.hpp"

#include <filesystem>
#include <fstream>
#include <set>

#include <gtest/gtest.h>

#include "support/temporary_folder.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;

struct Touched {
  std::set<std::string> new_folders;
  std::set<std::string> files;  ///< that were there
  int lines = 0;                ///< added to them
};

Touched touched_by(const std::string& section) {
  const fs::path top = FATHOM_SOURCE_DIR;
  const MarkdownPage page = read_markdown(top / "docs/extending.md");
  const TemporaryFolder copy;
  for (const CodeBlock& block : page.blocks) {
    if (block.title.empty() || !fs::exists(top / block.title)) continue;
    fs::create_directories((copy / block.title).parent_path());
    fs::copy_file(top / block.title, copy / block.title, fs::copy_options::overwrite_existing);
  }
  Touched touched;
  for (const FileChange& change : apply_examples(page, copy.path())) {
    if (change.section != section) continue;
    if (change.is_new) {
      touched.new_folders.insert(fs::path(change.file).parent_path().string());
    } else {
      touched.files.insert(change.file);
      touched.lines += change.lines_added;
    }
  }
  EXPECT_FALSE(touched.files.empty()) << section;
  return touched;
}

TEST(Extending, AnEstimatorTouchesItsFolderAndTwoLines) {
  const Touched touched = touched_by("An estimator");
  EXPECT_EQ(touched.new_folders.size(), 1u);
  EXPECT_LE(touched.lines, 2);
}

TEST(Extending, ADataSetTouchesItsFolderAndOneLine) {
  const Touched touched = touched_by("A data set");
  EXPECT_EQ(touched.new_folders.size(), 1u);
  EXPECT_LE(touched.lines, 1);
}

TEST(Extending, TheOthersTouchTwoFiles) {
  for (const char* section : {"A loss", "A detector", "A metric", "A cost", "A message of a bag"}) {
    const Touched touched = touched_by(section);
    EXPECT_TRUE(touched.new_folders.empty()) << section;
    EXPECT_LE(touched.files.size(), 2u) << section;
  }
}

TEST(Extending, ACommandTouchesItsFileAndALineOfThree) {
  const Touched touched = touched_by("A command");
  EXPECT_EQ(touched.new_folders, std::set<std::string>{"apps"});
  EXPECT_EQ(touched.files.size(), 3u);
}

TEST(Extending, ExamplesThatDoNotFitAreRefused) {
  const TemporaryFolder top;
  std::ofstream(top / "a.txt") << "one\ntwo\none\ntwo\nthree\n";
  const auto apply = [&](std::vector<std::string> lines, const std::string& language) {
    MarkdownPage page;
    page.blocks.push_back({language, "a.txt", "", std::move(lines)});
    return apply_examples(page, top.path());
  };
  EXPECT_THROW(apply({" four", "+five"}, "diff"), std::runtime_error);         // not there
  EXPECT_THROW(apply({" one", "+five", " two"}, "diff"), std::runtime_error);  // there twice
  EXPECT_THROW(apply({"new"}, "cpp"), std::runtime_error);                     // is there already
  const auto changes = apply({"-three", "+3", "+4"}, "diff");
  EXPECT_EQ(changes.front().lines_added, 2);
  EXPECT_EQ(fs::file_size(top / "a.txt"), std::string("one\ntwo\none\ntwo\n3\n4\n").size());
}

}  // namespace
}  // namespace fathom::test

#include "fathom/core/files.hpp"

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <sys/stat.h>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/few_descriptors.hpp"
#include "fathom/core/environment_error.hpp"
#include "fathom/core/system.hpp"
#include "support/input_error.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using test::input_error_of;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::UnorderedElementsAre;

std::vector<std::string> entries(const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    names.push_back(fs::relative(entry.path(), folder).string());
  }
  return names;
}

void put(const fs::path& path, const std::string& content) {
  std::ofstream(path) << content;
}

std::string content_of(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

class Files : public testing::Test {
 protected:
  test::TemporaryFolder folder_;
};

TEST_F(Files, ReadsEveryByte) {
  const std::string bytes("a\0b\r\n\xff", 6);
  std::ofstream(folder_ / "file", std::ios::binary) << bytes;
  EXPECT_EQ(read_file(folder_ / "file"), bytes);
  put(folder_ / "empty", "");
  EXPECT_EQ(read_file(folder_ / "empty"), "");
}

TEST_F(Files, ReadingNamesTheFile) {
  EXPECT_THAT(input_error_of([&] { read_file(folder_ / "none"); }), HasSubstr("none: cannot be"));
  EXPECT_THAT(input_error_of([&] { read_file(folder_.path()); }), HasSubstr("is a folder"));
}

TEST_F(Files, WritesWholeAndLeavesNothingElse) {
  write_file(folder_ / "file", "old");
  const std::string bytes("x\0y\n", 4);
  write_file(folder_ / "file", bytes);
  EXPECT_EQ(content_of(folder_ / "file"), bytes);
  EXPECT_THAT(entries(folder_.path()), UnorderedElementsAre("file"));
}

TEST_F(Files, AFailedWriteLeavesNothingAndNamesTheFile) {
  EXPECT_THAT(input_error_of([&] { write_file(folder_ / "none/file", "x"); }),
              HasSubstr("none/file: cannot be written"));
  fs::create_directories(folder_ / "taken/by a folder");
  EXPECT_THAT(input_error_of([&] { write_file(folder_ / "taken", "x"); }),
              HasSubstr("taken: cannot be written"));
  EXPECT_THAT(entries(folder_.path()), UnorderedElementsAre("taken", "taken/by a folder"));
}

TEST_F(Files, WhatIsNoFileIsNotReplacedByOne) {
  const fs::path pipe = folder_ / "pipe";
  ASSERT_EQ(::mkfifo(pipe.c_str(), 0600), 0);
  EXPECT_THAT(input_error_of([&] { write_file(pipe, "x"); }), HasSubstr("a device or a pipe"));
  EXPECT_TRUE(fs::is_fifo(pipe));
  const fs::path link = folder_ / "link";
  fs::create_symlink("pipe", link);
  EXPECT_THAT(input_error_of([&] { output_file(link); }), HasSubstr("link: is a device or a pipe"));
  EXPECT_EQ(output_file(folder_ / "new"), folder_ / "new");
}

// The name may be given on purpose; one that lies in a folder of results is nobody's wish.
TEST_F(Files, ALinkThatIsNamedStays) {
  put(folder_ / "file", "before");
  fs::create_symlink("file", folder_ / "link");
  write_file(output_file(folder_ / "link"), "after");
  EXPECT_TRUE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(content_of(folder_ / "file"), "after");
  write_file(folder_ / "link", "itself");
  EXPECT_FALSE(fs::is_symlink(folder_ / "link"));
  EXPECT_EQ(content_of(folder_ / "file"), "after");
}

TEST_F(Files, StagedFolderAppearsOnCommit) {
  {
    StagedFolder staged(folder_ / "a/b/c");
    EXPECT_EQ(staged.target(), folder_ / "a/b/c");
    put(staged.path() / "one.txt", "1");
    fs::create_directory(staged.path() / "pictures");
    put(staged.path() / "pictures/two.png", "2");
    staged.commit();
  }
  EXPECT_THAT(entries(folder_ / "a/b/c"),
              UnorderedElementsAre("one.txt", "pictures", "pictures/two.png"));
  EXPECT_EQ(content_of(folder_ / "a/b/c/one.txt"), "1");
}

TEST_F(Files, WithoutCommitNothingIsLeftNotEvenItsFolders) {
  fs::create_directory(folder_ / "kept");
  {
    StagedFolder staged(folder_ / "kept/new/newer");
    put(staged.path() / "half", "h");
  }
  EXPECT_THAT(entries(folder_.path()), UnorderedElementsAre("kept"));
  try {
    StagedFolder staged(folder_ / "kept");
    put(staged.path() / "half", "h");
    throw 1;  // what a failure half way does
  } catch (int) {
  }
  EXPECT_THAT(entries(folder_.path()), UnorderedElementsAre("kept"));
}

// Of a process that has ended.
std::string mark_of_dead() {
  const std::string own = process_mark();
  const std::string space = own.substr(own.find('-'));
  return "99999999" + space;  // process numbers end at 2^22 on Linux
}

TEST_F(Files, WhatAKilledProcessLeftIsRemoved) {
  fs::create_directory(folder_ / (".partial-" + mark_of_dead()));
  put(folder_ / (".partial-" + mark_of_dead()) / "half.txt", "h");
  put(folder_ / ("table.txt.partial-" + mark_of_dead()), "h");
  StagedFolder staged(folder_.path());
  put(staged.path() / "whole.txt", "w");
  staged.commit();
  EXPECT_THAT(entries(folder_.path()), UnorderedElementsAre("whole.txt"));
}

// A live process, or one of another machine or container, whose number says nothing here.
TEST_F(Files, WhatMayBeAtWorkElsewhereIsLeftAlone) {
  const std::vector<std::string> kept{
      ".partial-99999999", ".partial-99999999-0123456789abcdef",
      ".partial-1" + process_mark().substr(process_mark().find('-')), "notes.partial-final"};
  for (const std::string& name : kept) fs::create_directory(folder_ / name);
  StagedFolder(folder_.path()).commit();
  EXPECT_THAT(entries(folder_.path()), testing::UnorderedElementsAreArray(kept));
}

TEST_F(Files, WhatTheSystemRefusesIsAFaultOfTheEnvironment) {
  put(folder_ / "file", "f");
  EXPECT_THROW(write_file(folder_ / "none/file", "x"), EnvironmentError);
  EXPECT_THROW(StagedFolder(folder_ / "file/below"), EnvironmentError);
  EXPECT_THAT(input_error_of([&] {
                const test::FewDescriptors none_left;
                write_file(folder_ / "other", "x");
              }),
              HasSubstr("other: cannot be written: Too many open files"));
  const test::FewDescriptors none_left;
  EXPECT_THROW(read_file(folder_ / "file"), EnvironmentError);
}

// A name that is wrong is not the machine's fault.
TEST_F(Files, AFileThatIsNotThereIsBadInput) {
  try {
    read_file(folder_ / "none");
    FAIL();
  } catch (const EnvironmentError& error) {
    FAIL() << error.what();
  } catch (const InputError&) {
  }
}

TEST_F(Files, ATrailingSlashChangesNothing) {
  { const StagedFolder staged((folder_ / "new/").string()); }
  EXPECT_THAT(entries(folder_.path()), IsEmpty());
  {
    StagedFolder staged((folder_ / "new/").string());
    put(staged.path() / "file", "f");
    staged.commit();
  }
  EXPECT_THAT(entries(folder_.path()), UnorderedElementsAre("new", "new/file"));
}

TEST_F(Files, CommitReplacesItsOwnNamesAndKeepsOthers) {
  fs::create_directories(folder_ / "out/pictures");
  put(folder_ / "out/pictures/old.png", "old");
  put(folder_ / "out/metrics.json", "old");
  put(folder_ / "out/notes", "mine");
  StagedFolder staged(folder_ / "out");
  put(staged.path() / "metrics.json", "new");
  fs::create_directory(staged.path() / "pictures");
  put(staged.path() / "pictures/new.png", "new");
  EXPECT_EQ(content_of(folder_ / "out/metrics.json"), "old");  // until the commit
  staged.commit();
  EXPECT_THAT(entries(folder_ / "out"),
              UnorderedElementsAre("metrics.json", "notes", "pictures", "pictures/new.png"));
  EXPECT_EQ(content_of(folder_ / "out/metrics.json"), "new");
  EXPECT_EQ(content_of(folder_ / "out/notes"), "mine");
}

TEST_F(Files, RefusesATargetThatIsAFileOrLiesBelowOne) {
  put(folder_ / "file", "f");
  EXPECT_THAT(input_error_of([&] { StagedFolder(folder_ / "file"); }),
              HasSubstr("is a file; --out takes a folder"));
  EXPECT_THAT(input_error_of([&] { StagedFolder(folder_ / "file/below"); }),
              HasSubstr("cannot be made"));
  EXPECT_THAT(entries(folder_.path()), UnorderedElementsAre("file"));
  EXPECT_EQ(content_of(folder_ / "file"), "f");
}

TEST_F(Files, ARelativeTargetIsInTheWorkingFolder) {
  const fs::path before = fs::current_path();
  fs::current_path(folder_.path());
  {
    StagedFolder staged("here/out");
    fs::current_path(before);  // changing it meanwhile does no harm
    put(staged.path() / "file", "f");
    staged.commit();
  }
  EXPECT_THAT(entries(folder_.path()), UnorderedElementsAre("here", "here/out", "here/out/file"));
}

TEST(ReadFile, ReadsNoMoreThanItIsAllowed) {
  const test::TemporaryFolder folder;
  const std::string content(3'000'000, 'x');
  put(folder / "large", content);
  EXPECT_EQ(read_file(folder / "large"), content);
  EXPECT_EQ(read_file(folder / "large", content.size()), content);
  EXPECT_EQ(input_error_of([&] { read_file(folder / "large", content.size() - 1); }),
            (folder / "large").string() + ": is too large; the limit is 2999999 bytes");
  // A device has no end.
  EXPECT_EQ(input_error_of([&] { read_text("/dev/zero", 1000); }),
            "/dev/zero: is too large; the limit is 1000 bytes");
}

}  // namespace
}  // namespace fathom

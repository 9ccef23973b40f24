// Folders for temporary files.

#include "fathom/core/work_folder.hpp"

#include <cstdlib>
#include <filesystem>
#include <sys/wait.h>
#include <unistd.h>

#include <gmock/gmock.h>

#include "fathom/core/environment_error.hpp"
#include "fathom/core/files.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;
using ::testing::HasSubstr;

// TMPDIR is the test's own.
class WorkFolders : public ::testing::Test {
 public:
  WorkFolders() { ::setenv("TMPDIR", place_.path().c_str(), 1); }
  ~WorkFolders() override { ::unsetenv("TMPDIR"); }

 protected:
  TemporaryFolder place_;
};

TEST_F(WorkFolders, AreNewAndGoWithTheirOwner) {
  fs::path first;
  {
    const WorkFolder one("work");
    const WorkFolder other("work");
    first = one.path();
    EXPECT_NE(one.path(), other.path());
    EXPECT_TRUE(fs::is_empty(one.path()));
    EXPECT_EQ(one.path().parent_path(), place_.path());
    write_file(one.path() / "file", "text");
  }
  EXPECT_TRUE(fs::is_empty(place_.path())) << first;
}

TEST_F(WorkFolders, OfADeadProcessAreRemovedAndOthersStay) {
  const pid_t child = ::fork();
  if (child == 0) {
    new WorkFolder("work");
    ::_exit(0);
  }
  int status = 0;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  ASSERT_FALSE(fs::is_empty(place_.path()));
  const fs::path others = place_ / ("work-" + std::to_string(child));
  fs::create_directory(others);
  { const WorkFolder next("work"); }
  fs::remove(others);
  EXPECT_TRUE(fs::is_empty(place_.path()));
}

TEST_F(WorkFolders, NeedAPlaceWhoseNameIsSaid) {
  ::setenv("TMPDIR", "/no/such/place", 1);
  try {
    const WorkFolder none("work");
    FAIL() << "made";
  } catch (const EnvironmentError& error) {
    EXPECT_THAT(error.what(), HasSubstr("TMPDIR=/no/such/place: is no folder"));
  }
}

}  // namespace
}  // namespace fathom

// Programs of one name in one study, as two builds of a solver are.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "fathom/results/result_store.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::IsSupersetOf;

class ProgramsOfOneName : public CommandLine {
 protected:
  ProgramsOfOneName() {
    surroundings_.environment["FATHOM"] = FATHOM_BINARY;
    const std::string by_files = FATHOM_EXAMPLES "command/by_files.sh";
    for (const std::string build : {"v1", "v2", "v3"}) {
      const std::string name = build + "/solver";
      write(name, "#!/bin/sh\n# " + std::string(build == "v2" ? "other" : "same") + "\nexec " +
                      by_files + " \"$@\"\n");
      fs::permissions(path(name), fs::perms::owner_all);
    }
  }

  std::vector<std::string> files_of_study(const std::string& out) {
    const ResultStore store = ResultStore::open(path(out));
    std::vector<std::string> names;
    for (const auto& [file, hash] : store.study().data) names.push_back(file);
    return names;
  }
};

TEST_F(ProgramsOfOneName, AreToldApartByContent) {
  write("s.yaml",
        "dataset: {type: simulated_log, mission: {type: sweep, legs: 2, leg_length_m: 4}}\n"
        "trials: 1\nestimators:\n"
        "  - {type: command, name: old, command: 'v1/solver {input} {output}'}\n"
        "  - {type: command, name: new, command: 'v2/solver {input} {output}'}\n"
        "  - {type: command, name: copy, command: 'v3/solver {input} {output}'}\n");
  fathom_done({"compare", "s.yaml", "--out", "study"});
  const std::vector<std::string> names = files_of_study("study");
  EXPECT_THAT(names, IsSupersetOf({"program solver", "program solver (2)"}));
  EXPECT_EQ(std::ranges::count(names, "program solver (3)"), 0);
  // Another build is another study.
  write("v2/solver", "#!/bin/sh\n# a third\nexec false\n");
  EXPECT_EQ(fathom({"compare", "s.yaml", "--out", "study"}).status, 2);
}

}  // namespace
}  // namespace fathom::test

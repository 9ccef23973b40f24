// Man pages and completion: they say what --help says.

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::Not;

class Pages : public CommandLine {
 protected:
  using Words = std::vector<std::string>;

  void SetUp() override { fathom_done({"pages", "--out", "pages"}); }

  std::string page(const std::string& name) const {
    std::ostringstream text;
    text << std::ifstream(path("pages/man1/" + name + ".1")).rdbuf();
    return text.str();
  }

  // The first word of each line below a heading of --help.
  Words listed(const std::string& help, const std::string& heading) const {
    std::istringstream lines(help);
    Words words;
    bool is_in = false;
    for (std::string line; std::getline(lines, line);) {
      if (!line.starts_with(' ')) is_in = line == heading;
      std::smatch found;
      if (is_in && std::regex_search(line, found, std::regex(R"(^  (\S+))"))) {
        words.push_back(found[1]);
      }
    }
    return words;
  }

  Words commands() const { return listed(fathom_done({"--help"}).out, "Subcommands:"); }

  Words flags_of(const std::string& command) const {
    Words flags;
    for (const std::string& names : listed(fathom_done({command, "--help"}).out, "Options:")) {
      std::istringstream all(names);
      for (std::string name; std::getline(all, name, ',');) flags.push_back(name);
    }
    return flags;
  }

  Words lines_of(const std::string& shell) const {
    write("run.sh", "cd " + path("").string() + "\n" + shell);
    FILE* const pipe = ::popen(("bash " + path("run.sh").string() + " 2>&1").c_str(), "r");
    std::string text;
    for (int letter = std::fgetc(pipe); letter != EOF; letter = std::fgetc(pipe)) {
      text += static_cast<char>(letter);
    }
    EXPECT_EQ(::pclose(pipe), 0) << text;
    std::istringstream stream(text);
    Words lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
  }

  // What bash offers for the last word.
  Words offered(const std::string& words) const {
    return lines_of("source pages/fathom.bash\nCOMP_WORDS=(" + words +
                    ")\nCOMP_CWORD=$((${#COMP_WORDS[@]} - 1))\n_fathom\n"
                    "for word in \"${COMPREPLY[@]}\"; do echo \"$word\"; done\n");
  }
};

std::string in_bold(const std::string& flag) {
  return "\\fB" + std::regex_replace(flag, std::regex("-"), "\\-") + "\\fR";
}

TEST_F(Pages, NameEveryCommand) {
  const Words all = commands();
  ASSERT_GE(all.size(), 19u);
  EXPECT_THAT(all, Not(Contains("pages")));
  EXPECT_THAT(offered("fathom ''"), IsSupersetOf(all));
  for (const std::string& command : all) {
    EXPECT_THAT(page("fathom"), HasSubstr("\\fBfathom\\-" + command + "\\fR(1)"));
  }
}

TEST_F(Pages, NameEveryFlagAndSayWhatItDoes) {
  for (const std::string& command : commands()) {
    const Words flags = flags_of(command);
    ASSERT_THAT(flags, Contains("--help")) << command;
    EXPECT_THAT(offered("fathom " + command + " -"), IsSupersetOf(flags)) << command;
    for (const std::string& flag : flags) {
      EXPECT_THAT(page("fathom-" + command), HasSubstr(in_bold(flag))) << command << flag;
    }
  }
  EXPECT_THAT(page("fathom-solve"),
              AllOf(HasSubstr("keyframe by keyframe"), HasSubstr("One of: incremental, batch."),
                    HasSubstr("Default: odometry."), HasSubstr("fathom solve intel.g2o")));
}

TEST_F(Pages, ManReadsThem) {
  if (std::system("command -v man > /dev/null") != 0) {
    GTEST_SKIP() << "no man here; 'scripts/setup.sh' installs it";
  }
  EXPECT_THAT(lines_of("export LC_ALL=C.UTF-8 MANWIDTH=100\nfor page in pages/man1/*; do\n"
                       "  man --warnings -l $page 2>&1 > /dev/null\ndone\n"),
              ElementsAre());
}

TEST_F(Pages, ValuesAreOffered) {
  EXPECT_THAT(offered("fathom solve --mode ''"), ElementsAre("incremental", "batch"));
  EXPECT_THAT(offered("fathom solve --mode = b"), ElementsAre("batch"));
  EXPECT_THAT(offered("fathom solve --mode ="), ElementsAre("incremental", "batch"));
  EXPECT_THAT(offered("fathom solve g.g2o --estimator tr"), ElementsAre("trajectory_iekf"));
  EXPECT_THAT(offered("fathom conformance ek"), ElementsAre("ekf"));
  EXPECT_THAT(offered("fathom list ''"),
              ElementsAre("estimators", "detectors", "datasets", "metrics", "features"));
  EXPECT_THAT(offered("fathom select d --minimise anee"), Contains("anees"));
  EXPECT_THAT(offered("fathom evaluate a b --align s"), ElementsAre("se2"));
}

TEST_F(Pages, FoldersAreOfferedWhereOneIsWanted) {
  write("a file", "");
  std::filesystem::create_directories(path("a folder"));
  EXPECT_THAT(offered("fathom run c.yaml --out a"), ElementsAre("a folder"));
  // No word: bash offers files of itself.
  EXPECT_THAT(offered("fathom run a"), ElementsAre());
}

}  // namespace
}  // namespace fathom::test

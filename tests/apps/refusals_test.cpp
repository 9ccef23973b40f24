// What is given in place of something else: named with its place and what would be right.

#include <filesystem>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Refusals : public CommandLine {};

TEST_F(Refusals, WordsHaveTheNearest) {
  write("g.g2o", kTwoPoses);
  write("t.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n");
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{"evaluate", "a", "b", "--align", "orign"}, "did you mean 'origin'?"},
      {{"convert", "t.tum", "--to", "tum", "--out", "o", "--from", "euroq"},
       "did you mean 'euroc'?"},
      {{"convert", "t.tum", "--to", "tum", "--out", "o", "--plane", "xzz"}, "did you mean 'xz'?"},
      {{"versoin"}, "did you mean '--version'?"},
      {{"conformance", "--qiet"}, "did you mean '--quiet'?"},
      {{"solve", "g.g2o", "--estimator", "one_by_one"}, "and those of --plugin FILE"},
      {{"list", "estimatrs"}, "did you mean 'estimators'? (see fathom list --help)"},
      {{"compare", "--trials", "two"}, "got 'two' (see fathom compare --help)"}};
  for (const auto& [arguments, text] : cases) {
    EXPECT_THAT(refusal(arguments), HasSubstr(text)) << arguments.front();
  }
  write("s.yaml", "dataset: {type: simulated_log}\nestimators: [{type: ekf, nam: x}]\n");
  EXPECT_THAT(refusal({"compare", "s.yaml"}), HasSubstr("did you mean 'estimators.0.name'?"));
  EXPECT_THAT(refusal({"compare", "s.yaml", "--trials", "0"}), StartsWith("--trials: expected"));
}

TEST_F(Refusals, HelpIsACommandToo) {
  EXPECT_EQ(fathom_done({"help"}).out, fathom_done({"--help"}).out);
  EXPECT_EQ(fathom_done({"help", "run"}).out, fathom_done({"run", "--help"}).out);
}

TEST_F(Refusals, MissingDataIsNamedByItsLine) {
  const std::string base = "; paths start at the working folder, ";
  for (const char* const type : {"image_folder", "pictures"}) {
    write("c.yaml", "seed: 1\ndataset:\n  type: " + std::string(type) + "\n  path: ../picturs\n");
    EXPECT_THAT(refusal({"run", "c.yaml"}),
                HasSubstr("c.yaml:4: dataset.path: there is no '../picturs'" + base));
  }
  write("c.yaml", "dataset: {type: g2o, path: nofile.g2o}\n");
  EXPECT_THAT(refusal({"run", "c.yaml"}),
              HasSubstr("c.yaml:1: dataset.path: there is no 'nofile.g2o'" + base));
  write("c.yaml", "seed: 1\ndataset: {type: image_folder}\n");
  EXPECT_THAT(refusal({"run", "c.yaml"}), HasSubstr("c.yaml:2: dataset.path: say where"));
  EXPECT_THAT(refusal({"run", "nofile.g2o"}), Not(HasSubstr("dataset.path")));
}

TEST_F(Refusals, OfAFolderOfARun) {
  write("g.g2o", kTwoPoses);
  fathom_done({"solve", "g.g2o", "--out", "run"});
  EXPECT_THAT(refusal({"solve", "run"}), EndsWith("the graph in it is run/measurements.g2o\n"));
  const std::string no_study = "run: is the folder of a run; expected that of a study";
  EXPECT_THAT(refusal({"report", "run"}), HasSubstr(no_study));
  EXPECT_THAT(refusal({"status", "run"}), HasSubstr(no_study));
  EXPECT_THAT(refusal({"check", "run/metrics.json"}), HasSubstr("is JSON; expected"));
  EXPECT_THAT(refusal({"check", "nope.json"}), Not(HasSubstr("is JSON")));
}

TEST_F(Refusals, OfNoCache) {
  write("run.yaml", "seed: 1\n");
  write("full/file", "x");
  std::filesystem::create_directory(path("empty"));
  for (const char* const folder : {"nofolder", "run.yaml", "full"}) {
    EXPECT_THAT(refusal({"cache", "--cache", folder}), HasSubstr("is no cache")) << folder;
    EXPECT_THAT(refusal({"cache", "--clear", "--cache", folder}), HasSubstr("is no cache"));
  }
  EXPECT_THAT(fathom_done({"cache", "--cache", "empty"}).out, HasSubstr("0 registrations"));
  write("damaged/registrations.sqlite", "no database");
  EXPECT_THAT(refusal({"cache", "--cache", "damaged"}), HasSubstr("fathom cache --clear"));
  EXPECT_THAT(fathom_done({"cache", "--clear", "--cache", "damaged"}).out,
              HasSubstr("0 registrations"));
}

TEST_F(Refusals, OfAConfigurationWithoutAKey) {
  write("empty.yaml", "# nothing\n");
  for (const char* const command : {"run", "compare", "check"}) {
    EXPECT_THAT(refusal({command, "empty.yaml"}), AllOf(HasSubstr("empty.yaml: is empty")));
  }
  fathom_done({"check", "empty.yaml", "--set", "dataset.type=simulated_log"});
}

TEST_F(Refusals, QuietIsAFlagOfAllThatPrint) {
  const std::vector<Arguments> cases{
      {"list", "estimators"}, {"conformance", "--list"}, {"cache", "--cache", "."}};
  for (Arguments arguments : cases) {
    EXPECT_NE(fathom_done(arguments).out, "");
    arguments.push_back("--quiet");
    EXPECT_EQ(fathom_done(arguments).out, "") << arguments.front();
  }
}

}  // namespace
}  // namespace fathom::test

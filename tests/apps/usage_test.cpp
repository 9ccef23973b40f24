// Help, version, lists and misuse.

#include <filesystem>
#include <regex>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "harness/small_config.hpp"
#include "support/requirements.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::StartsWith;

class Usage : public CommandLine {};

const std::vector<std::string>& commands() {
  static const std::vector<std::string> all{
      "run",   "compare", "solve",  "register", "simulate", "evaluate",   "list",
      "check", "report",  "select", "mosaic",   "convert",  "conformance"};
  return all;
}

TEST_F(Usage, HelpListsTheCommands) {
  const Ended ended = fathom_done({"--help"});
  for (const std::string& command : commands()) EXPECT_THAT(ended.out, HasSubstr(command));
}

TEST_F(Usage, EveryCommandHasAnExample) {
  for (const std::string& command : commands()) {
    const Ended ended = fathom_done({command, "--help"});
    EXPECT_THAT(ended.out, HasSubstr("Example: fathom " + command)) << command;
  }
}

TEST_F(Usage, TheConfigurationsOfTheExamplesAreShipped) {
  std::size_t seen = 0;
  for (const std::string& command : commands()) {
    const std::string help = fathom_done({command, "--help"}).out;
    const std::regex name(R"(configs/\w+\.yaml)");
    for (std::sregex_iterator found(help.begin(), help.end(), name), end; found != end; ++found) {
      EXPECT_TRUE(std::filesystem::exists(std::filesystem::path(FATHOM_SOURCE_DIR) / found->str()))
          << command << ": " << found->str();
      ++seen;
    }
  }
  EXPECT_GE(seen, 4u);
}

TEST_F(Usage, VersionIsOneLine) {
  const Ended ended = fathom_done({"--version"});
  EXPECT_TRUE(std::regex_match(ended.out, std::regex(R"(fathom \d+\.\d+\.\d+\n)"))) << ended.out;
}

TEST_F(Usage, ListNamesEverythingWithItsOptions) {
  EXPECT_THAT(fathom_done({"list", "estimators"}).out,
              AllOf(HasSubstr("trajectory_iekf: "), HasSubstr("ekf: "),
                    HasSubstr("ceres_pose_graph: "), HasSubstr("estimator.gate_probability")));
  EXPECT_THAT(fathom_done({"list", "detectors"}).out,
              AllOf(HasSubstr("sift: "), HasSubstr("orb: "), HasSubstr("akaze: "),
                    HasSubstr("brisk: "), HasSubstr("front_end.ransac.max_error_m")));
  EXPECT_THAT(fathom_done({"list", "datasets"}).out,
              AllOf(HasSubstr("simulated: "), HasSubstr("image_folder: "), HasSubstr("g2o: "),
                    HasSubstr("dataset.altitude.base_m")));
  EXPECT_THAT(fathom_done({"list", "metrics"}).out,
              AllOf(HasSubstr("mean_position_error_m"), HasSubstr("rpe_N_keyframes_rad"),
                    HasSubstr("peak heap of the estimator")));
}

TEST_F(Usage, MisuseIsOneLineAndStatusTwo) {
  write("g.g2o", kTwoPoses);
  const std::vector<std::pair<Arguments, std::string>> cases{
      {{}, "a command is missing (fathom --help lists them)"},
      {{"runn", "a.yaml"}, "unknown command 'runn'; did you mean 'run'?"},
      {{"help", "runn"}, "unknown command 'runn'; did you mean 'run'?"},
      {{"frobnicate"}, "unknown command 'frobnicate' (fathom --help lists them)"},
      {{"--versoin"}, "unknown flag '--versoin'; did you mean '--version'?"},
      {{"run"}, "'config' is missing: Configuration (YAML), a folder"},
      {{"run", "a.yaml", "b.yaml"}, "'b.yaml' is a word too many (see fathom run --help)"},
      {{"run", "a.yaml", "--ou", "x"}, "unknown flag '--ou'; did you mean '--out'?"},
      {{"run", "--sett", "a=b"}, "unknown flag '--sett'; did you mean '--set'?"},
      {{"run", "a.yaml", "--sseed=3"}, "unknown flag '--sseed'; did you mean '--seed'?"},
      {{"solve", "g.g2o", "--batch"}, "unknown flag '--batch'; did you mean '--mode batch'?"},
      {{"run", "a.yaml", "---"}, "unknown flag '---'"},
      {{"run", "a.yaml", "--out"}, "--out"},
      {{"run", "a.yaml", "--out", "--no-mosaic"}, "got the flag '--no-mosaic'; a file of this"},
      {{"run", "a.yaml", "--seed", "x"}, "--seed"},
      {{"run", "a.yaml", "--set"}, "--set: expected KEY=VALUE after it"},
      {{"solve", "g.g2o", "--mode", "bacth"}, "--mode: expected one of incremental, batch, got"},
      {{"solve", "g.g2o", "--mode", "bacth"}, "did you mean 'batch'?"},
      {{"solve", "g.g2o", "--init", "guess"}, "--init"},
      {{"list"}, "'what' is missing: "},
      {{"list", "metrisc"}, "got 'metrisc'; did you mean 'metrics'?"},
      {{"evaluate", "a.tum"}, "'reference' is missing: "},
      {{"register", "a.png", "b.png"}, "'--altitude-a' is missing: Height of A"},
      {{"register", "a.png", "b.png", "--altitude-a", "0", "--altitude-b", "1"}, "--altitude-a"},
      {{"register", "a.png", "b.png", "--altitude-a", "1", "--altitude-b", "-1"}, "--altitude-b"}};
  for (const auto& [arguments, message] : cases) {
    EXPECT_THAT(refusal(arguments), HasSubstr(message));
  }
}

TEST_F(Usage, MessagesAreOneLineWhateverIsInTheNames) {
  EXPECT_THAT(refusal({"run", "no\nsuch\tfile"}), StartsWith("no such file: cannot be opened"));
  EXPECT_THAT(refusal({"run", "a", "--set", "a\nb"}), Not(HasSubstr("internal")));
  EXPECT_THAT(refusal({"fro\nbnicate"}), HasSubstr("unknown command"));
  EXPECT_THAT(refusal({"check", std::string(5000, 'a')}), HasSubstr("name too long"));
}

TEST_F(Usage, AnOutFolderThatCannotBeIsRefused) {
  write("g.g2o", kTwoPoses);
  write("file", "");
  EXPECT_THAT(refusal({"solve", "g.g2o", "--out", "file"}), HasSubstr("is a file; --out takes"));
  EXPECT_THAT(refusal({"solve", "g.g2o", "--out", "file/below"}), HasSubstr("file/below"));
  EXPECT_THAT(refusal({"solve", "g.g2o", "--out", std::string(5000, 'a')}),
              Not(HasSubstr("internal")));
}

TEST_F(Usage, AReadOnlyOutFolderIsRefused) {
  FATHOM_REQUIRE_NO_ROOT();
  write("g.g2o", kTwoPoses);
  namespace fs = std::filesystem;
  fs::create_directory(path("locked"));
  fs::permissions(path("locked"), fs::perms::owner_read | fs::perms::owner_exec);
  EXPECT_THAT(refusal({"solve", "g.g2o", "--out", "locked"}), HasSubstr("locked"));
  EXPECT_THAT(refusal({"solve", "g.g2o", "--out", "locked/below"}), HasSubstr("locked"));
  fs::permissions(path("locked"), fs::perms::owner_all);
}

TEST_F(Usage, AFailureLeavesAnOutFolderAsItWas) {
  write("bad.g2o", "EDGE_SE2 0 1 nonsense\n");
  write("out/metrics.json", "mine");
  write("out/notes.txt", "mine too");
  refusal({"solve", "bad.g2o", "--out", "out"});
  refusal({"solve", "bad.g2o", "--out", "new/deep/down"});
}

TEST_F(Usage, AnotherRunReplacesItsFilesAndLeavesTheRest) {
  write("g.g2o", kTwoPoses);
  write("out/metrics.json", "old");
  write("out/notes.txt", "mine");
  fathom_done({"solve", "g.g2o", "--out", "out"});
  EXPECT_EQ(json_of("out/metrics.json").at("keyframes"), 2);
  EXPECT_TRUE(std::filesystem::exists(path("out/notes.txt")));
}

TEST_F(Usage, QuietPrintsNothing) {
  write("g.g2o", kTwoPoses);
  write("c.yaml", kSmallSurvey);
  const std::vector<Arguments> cases{{"solve", "g.g2o"}, {"run", "c.yaml"}, {"simulate", "c.yaml"}};
  for (Arguments arguments : cases) {
    arguments.insert(arguments.end(), {"--quiet", "--out", "out-" + arguments[0]});
    EXPECT_EQ(fathom_done(arguments).out, "") << arguments[0];
    EXPECT_TRUE(std::filesystem::exists(path("out-" + arguments[0])));
  }
}

}  // namespace
}  // namespace fathom::test

// Numbers are read in one way wherever they stand, and a byte order mark is no part of a text.

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "fathom/core/files.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;
using ::testing::Not;

class Numbers : public CommandLine {
 protected:
  std::string seed_of_run(const Arguments& given) const {
    Arguments arguments{"run", "c.yaml", "--out", "out", "--no-mosaic", "--quiet"};
    arguments.insert(arguments.end(), given.begin(), given.end());
    fathom_done(arguments);
    return json_of("out/run.json").at("configuration").at("seed").get<std::string>();
  }
};

TEST_F(Numbers, ASeedIsDecimalWhereverItIsGiven) {
  write("c.yaml", kSmallSurvey);
  EXPECT_EQ(seed_of_run({"--seed", "010"}), "10");
  EXPECT_EQ(seed_of_run({"--set", "seed=010"}), "10");
  write("c.yaml", std::string(kSmallSurvey) + "seed: 010\n");
  EXPECT_EQ(seed_of_run({}), "10");
}

TEST_F(Numbers, WhatIsNoDecimalNumberIsRefusedByEveryFlag) {
  write("c.yaml", kSmallSurvey);
  write("g.g2o", square_graph(200, 10));
  write("a.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  const std::vector<std::pair<Arguments, std::string>> flags{
      {{"run", "c.yaml"}, "--seed"},
      {{"compare", "c.yaml"}, "--trials"},
      {{"compare", "c.yaml"}, "--jobs"},
      {{"spoil", "g.g2o", "--out", "o.g2o"}, "--share"},
      {{"spoil", "g.g2o", "--out", "o.g2o"}, "--seed"},
      {{"spoil", "g.g2o", "--out", "o.g2o", "--kind", "grouped"}, "--group-size"},
      {{"spoil", "g.g2o", "--out", "o.g2o", "--kind", "local"}, "--reach"},
      {{"evaluate", "a.tum", "a.tum"}, "--max-difference"},
      {{"evaluate", "a.tum", "a.tum"}, "--step"},
      {{"evaluate", "a.tum", "a.tum"}, "--distance"},
      {{"select", "results"}, "--allow-failures"},
      {{"mosaic", "run"}, "--resolution"},
      {{"mosaic", "run"}, "--max-difference"},
      {{"register", "a.png", "b.png", "--altitude-b", "2"}, "--altitude-a"},
      {{"register", "a.png", "b.png", "--altitude-a", "2"}, "--altitude-b"}};
  for (const auto& [command, flag] : flags) {
    for (const std::string number : {"0x10", "nan", "-1"}) {
      Arguments arguments = command;
      arguments.push_back(flag + "=" + number);
      const std::string message = refusal(arguments);
      EXPECT_THAT(message, HasSubstr(flag)) << number;
      EXPECT_THAT(message, HasSubstr("number")) << number;
      EXPECT_LT(message.size(), 120u) << message;
    }
  }
}

TEST_F(Numbers, AndByEveryFile) {
  for (const std::string number : {"0x10", "inf", "1x"}) {
    write("c.yaml", std::string(kSmallSurvey) + "seed: " + number + "\n");
    EXPECT_THAT(refusal({"run", "c.yaml"}), HasSubstr("expected a whole number")) << number;
    write("g.g2o", "EDGE_SE2 0 1 " + number + " 0 0 1 0 0 1 0 1\n");
    EXPECT_THAT(refusal({"solve", "g.g2o"}), HasSubstr("number")) << number;
    write("a.tum", "0 " + number + " 0 0 0 0 0 1\n");
    EXPECT_THAT(refusal({"evaluate", "a.tum", "a.tum"}), HasSubstr("number")) << number;
  }
}

TEST_F(Numbers, AByteOrderMarkIsSkipped) {
  const std::string mark = "\xEF\xBB\xBF";
  write("c.yaml", mark + kSmallSurvey);
  write("g.g2o", mark + kTwoPoses);
  write("a.tum", mark + "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  fathom_done({"check", "c.yaml"});
  fathom_done({"check", "a.tum"});
  fathom_done({"check", "g.g2o"});
  fathom_done({"solve", "g.g2o", "--out", "solved"});
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  for (const std::string name : {"odometry0/data.csv", "cam0/data.csv", "cam0/sensor.yaml"}) {
    write("data/mav0/" + name, mark + read_file(path("data/mav0/" + name)));
  }
  fathom_done({"check", "data"});
}

}  // namespace
}  // namespace fathom::test

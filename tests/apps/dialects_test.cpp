// What other programs write: evaluate, solve, convert and check read it, or name what it is.

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "apps/graphs.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kUnit = " 1 0 0 1 0 1\n";

// Round a circle; stamps 0.05 s apart from `start_s` on, in the format of C++.
std::string circle(double start_s, const char* stamp = "{:.2f}", const std::string& separator = " ",
                   bool is_w_first = false) {
  std::string text;
  for (int k = 0; k < 40; ++k) {
    const double half = 0.075 * k;
    const auto [x, y] = std::pair{5.0 * std::sin(2.0 * half), -5.0 * std::cos(2.0 * half)};
    text += fmt::format(fmt::runtime(stamp), start_s + 0.05 * k);
    const auto [s, c] = std::pair{std::sin(half), std::cos(half)};
    const auto values =
        is_w_first ? std::array{x, y, 0.0, c, 0.0, 0.0, s} : std::array{x, y, 0.0, 0.0, 0.0, s, c};
    for (const double value : values) text += separator + fmt::format("{:.9f}", value);
    text += '\n';
  }
  return text;
}

class Dialects : public Commands {
 protected:
  // By evaluate, convert and check alike.
  std::string refused(const std::string& name) {
    const std::string message = refusal({"evaluate", name, "reference.tum"});
    EXPECT_EQ(refusal({"evaluate", "reference.tum", name}), message);
    EXPECT_EQ(refusal({"convert", name, "--to", "euroc", "--out", "out"}), message);
    EXPECT_EQ(refusal({"check", name}), message);
    EXPECT_THAT(message, AllOf(Not(HasSubstr("-u")), Not(HasSubstr("uniq"))));
    return message;
  }
  void SetUp() override { write("reference.tum", circle(1403636579.0)); }
};

TEST_F(Dialects, TrajectoriesOfNoUseAreNamed) {
  write("digits.tum", circle(1403636579.0, "{:g}"));
  write("runs.tum", circle(1403636579.0) + circle(1403636579.02));
  write("order.tum", circle(1403636579.0, "{:.2f}", " ", true));
  std::string commas = circle(1403636579.0);
  std::replace(commas.begin(), commas.end(), '.', ',');
  write("commas.tum", commas);
  EXPECT_THAT(refused("digits.tum"), HasSubstr("digits.tum:2: 40 poses have 1 time stamp between"));
  EXPECT_THAT(refused("runs.tum"), HasSubstr("runs.tum:41: time goes back from '1403636580.95'"));
  EXPECT_THAT(refused("order.tum"), HasSubstr("order.tum: its quaternions look like qw qx qy qz"));
  EXPECT_THAT(refused("commas.tum"), HasSubstr("commas.tum:1: decimal commas?"));
}

TEST_F(Dialects, TumWithCommasAndNanosecondsAsFloatsAreRead) {
  write("commas.txt", circle(1403636579.0, "{:.2f}", ","));
  std::string euroc = "#t\n";
  for (int k = 0; k < 40; ++k) {
    euroc += fmt::format("{}.0,{:.9f},{:.9f},0,{:.9f},0,0,{:.9f}\n",
                         1403636579000000000 + 50000000 * k, 5.0 * std::sin(0.15 * k),
                         -5.0 * std::cos(0.15 * k), std::cos(0.075 * k), std::sin(0.075 * k));
  }
  write("floats.csv", euroc);
  for (const std::string name : {"commas.txt", "floats.csv"}) {
    EXPECT_THAT(
        fathom_done({"evaluate", name, "reference.tum", "--align", "none"}).out,
        AllOf(HasSubstr("40 of 40 poses"), ::testing::ContainsRegex("ATE RMSE .m. +0\\.?0*\n")));
    fathom_done({"convert", name, "--to", "tum", "--out", name + ".tum"});
    expect_same_trajectory(name + ".tum", "reference.tum", 1e-8);
  }
  EXPECT_THAT(fathom_done({"check", "commas.txt"}).out, HasSubstr("poses        40"));
}

TEST_F(Dialects, GraphsOfNoUseAreNamed) {
  write("order.g2o", "EDGE2 0 1 1 0 0" + kUnit + "EDGE2 1 2 1 0 0" + kUnit);
  write("equiv.g2o", kTwoPoses + "EQUIV 0 1\n");
  write("landmarks.g2o", kTwoPoses + "VERTEX_XY 2 1 1\nEDGE_SE2_XY 0 2 1 1 1 0 1\n");
  write("self.g2o", kTwoPoses + "EDGE_SE2 1 1 1 0 0" + kUnit);
  const std::vector<std::pair<std::string, std::string>> all{
      {"order.g2o", "order.g2o:1: the information matrix is not positive definite, as of 2 of 2"},
      {"equiv.g2o", "equiv.g2o:4: EQUIV says that two ids are one vertex"},
      {"landmarks.g2o", "landmarks.g2o:4: landmarks (1 VERTEX_XY, 1 EDGE_SE2_XY)"},
      {"self.g2o", "self.g2o:4: an edge from pose 1 to itself"}};
  for (const auto& [name, said] : all) {
    EXPECT_THAT(refusal({"solve", name, "--out", "out"}), HasSubstr(said));
    EXPECT_THAT(refusal({"convert", name, "--to", "toro", "--out", "out"}), HasSubstr(said));
    EXPECT_THAT(fathom({"check", name}).err, HasSubstr(said));
  }
}

TEST_F(Dialects, LandmarksAreLeftOutOnDemand) {
  write("g.g2o", kTwoPoses + "VERTEX_XY 2 1 1\nEDGE_SE2_XY 0 2 1 1 1 0 1\n");
  EXPECT_THAT(
      fathom_done({"convert", "g.g2o", "--to", "g2o", "--drop-landmarks", "--out", "p.g2o"}).out,
      AllOf(HasSubstr("left out: 1 line VERTEX_XY, of landmarks"),
            HasSubstr("left out: 1 line EDGE_SE2_XY, of landmarks")));
  EXPECT_EQ(bytes_of("p.g2o"), kTwoPoses);
  EXPECT_THAT(
      refusal({"convert", "reference.tum", "--to", "kitti", "--drop-landmarks", "--out", "out"}),
      HasSubstr("--drop-landmarks: is for pose graphs alone"));
}

TEST_F(Dialects, EdgesFromAPoseToItselfAreLeftOutOnDemand) {
  const std::string said = "1 edge from a pose to itself left out";
  write("g.g2o", square_graph(130, 10) + "EDGE_SE2 7 7 1 0 0" + kUnit);
  write("clean.g2o", square_graph(130, 10));
  write("c.yaml", "dataset: {type: g2o, path: g.g2o, drop_self_edges: true}\n");
  EXPECT_THAT(fathom_done({"solve", "g.g2o", "--drop-self-edges", "--out", "a"}).out,
              HasSubstr(said));
  EXPECT_THAT(
      fathom_done({"solve", "g.g2o", "--set", "dataset.drop_self_edges=true", "--out", "b"}).out,
      HasSubstr(said));
  fathom_done({"solve", "clean.g2o", "--out", "c"});
  EXPECT_EQ(bytes_of("a/trajectory.tum"), bytes_of("c/trajectory.tum"));
  EXPECT_EQ(bytes_of("b/trajectory.tum"), bytes_of("c/trajectory.tum"));
  const nlohmann::json run = json_of("a/run.json");
  EXPECT_EQ(run.at("configuration").at("dataset.drop_self_edges"), "true");
  EXPECT_EQ(run.at("remarks").at(0), said);
  EXPECT_THAT(fathom_done({"check", "g.g2o", "--drop-self-edges"}).out, HasSubstr(said));
  EXPECT_THAT(fathom_done({"run", "c.yaml", "--out", "d"}).out, HasSubstr(said));
  fathom_done({"spoil", "g.g2o", "--drop-self-edges", "--out", "e.g2o"});
  EXPECT_THAT(
      fathom_done({"convert", "g.g2o", "--to", "g2o", "--drop-self-edges", "--out", "f.g2o"}).out,
      HasSubstr("left out: 1 edge from a pose to itself"));
  EXPECT_EQ(bytes_of("f.g2o"), bytes_of("clean.g2o"));
}

TEST_F(Dialects, KeysOfGtsamAreSolvedUnderTheirPlaces) {
  const std::string x0 = "8646911284551352320";
  const std::string x1 = "8646911284551352321";
  const std::string x3 = "8646911284551352323";
  write("g.g2o", "EDGE_SE2 " + x0 + " " + x1 + " 1 0 0" + kUnit + "EDGE_SE2 " + x1 + " " + x3 +
                     " 1 0 0" + kUnit + "EDGE_SE2 " + x3 + " " + x0 + " -2.3 0 0" + kUnit);
  write("truth.tum", "0 0 0 0 0 0 0 1\n1 1.1 0 0 0 0 0 1\n2 2.2 0 0 0 0 0 1\n");
  const std::string said = "too large for time stamps: trajectories have 0 to 2 in their place";
  EXPECT_THAT(fathom_done({"solve", "g.g2o", "--ground-truth", "truth.tum", "--out", "out"}).out,
              AllOf(HasSubstr("ids up to " + x3 + " are " + said), HasSubstr("ids.csv has both")));
  EXPECT_EQ(bytes_of("out/ids.csv"), "stamp,id\n0," + x0 + "\n1," + x1 + "\n2," + x3 + "\n");
  // By hand: three springs in a ring share the gap of 0.3 m.
  EXPECT_NEAR(json_of("out/metrics.json").at("mean_position_error_m").get<double>(), 0.0, 1e-6);
  EXPECT_EQ(tum("out/trajectory.tum")[2].time_ns, 2'000'000'000);
  EXPECT_THAT(bytes_of("out/measurements.g2o"), HasSubstr("EDGE_SE2 " + x1 + " " + x3 + " 1 0 0"));
  EXPECT_THAT(bytes_of("out/registrations.csv"), HasSubstr(x3 + "," + x0 + ",used"));
  // By the numbers of the symbols 0, 1, 3 it would not fit, nor with poses between.
  write("symbols.tum", "0 0 0 0 0 0 0 1\n1 1.1 0 0 0 0 0 1\n3 2.2 0 0 0 0 0 1\n");
  write("more.tum", "0 0 0 0 0 0 0 1\n1 1.1 0 0 0 0 0 1\n2 1.6 0 0 0 0 0 1\n3 2.2 0 0 0 0 0 1\n");
  for (const std::string name : {"symbols.tum", "more.tum"}) {
    EXPECT_THAT(refusal({"solve", "g.g2o", "--ground-truth", name, "--out", "again"}),
                HasSubstr(name + ": expected a pose for each of the time stamps 0 to 2"));
  }
  write("c.yaml", "dataset: {type: g2o, path: g.g2o}\n");
  EXPECT_THAT(fathom_done({"run", "c.yaml", "--out", "run"}).out, HasSubstr(said));
  EXPECT_EQ(bytes_of("run/ids.csv"), bytes_of("out/ids.csv"));
  EXPECT_THAT(fathom_done({"check", "g.g2o"}).out, HasSubstr(said));
}

}  // namespace
}  // namespace fathom::test

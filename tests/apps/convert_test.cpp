// convert: trajectories and graphs in another format.

#include <sys/stat.h>

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "apps/graphs.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

const std::string kEuroc =
    "#timestamp,p_x,p_y,p_z,q_w,q_x,q_y,q_z,v\n"
    "1403636579763555527,1,2,0.5,1,0,0,0,9\n"
    "1403636579863555528,2,2,0.25,0.5,0.5,0.5,0.5,9\n";

TEST_F(Commands, ConvertThereAndBackKeepsNanosecondsAndDigits) {
  write("t.csv", kEuroc);
  EXPECT_THAT(fathom_done({"convert", "t.csv", "--to", "tum", "--out", "t.tum"}).out,
              AllOf(HasSubstr("2 poses, EuRoC to TUM"), HasSubstr("left out: columns 9 to 9"),
                    HasSubstr("wrote t.tum")));
  EXPECT_EQ(bytes_of("t.tum"),
            "# t x y z qx qy qz qw\n"
            "1403636579.763555527 1 2 0.5 0 0 0 1\n"
            "1403636579.863555528 2 2 0.25 0.5 0.5 0.5 0.5\n");
  EXPECT_EQ(fathom_done({"convert", "t.tum", "--to", "euroc", "--out", "b.csv", "--quiet"}).out,
            "");
  fathom_done({"convert", "b.csv", "--to", "tum", "--out", "b.tum"});
  EXPECT_EQ(bytes_of("b.tum"), bytes_of("t.tum"));
  EXPECT_THAT(fathom_done({"convert", "t.tum", "--to", "kitti", "--out", "t.txt"}).out,
              HasSubstr("--times-out FILE writes them"));
  EXPECT_EQ(bytes_of("t.txt"), "1 0 0 1 0 1 0 2 0 0 1 0.5\n0 0 1 2 1 0 0 2 0 1 0 0.25\n");
  fathom_done({"convert", "t.tum", "--to", "kitti", "--out", "t.txt", "--times-out", "times"});
  fathom_done({"convert", "t.txt", "--times", "times", "--to", "tum", "--out", "k.tum"});
  EXPECT_EQ(bytes_of("k.tum"), bytes_of("t.tum"));
  EXPECT_THAT(fathom_done({"convert", "t.txt", "--to", "tum", "--out", "i.tum"}).out,
              HasSubstr("the time is the index"));
}

TEST_F(Commands, ConvertProjectsAndSaysWhatIsLost) {
  write("t.csv", kEuroc);
  const std::string said =
      fathom_done({"convert", "t.csv", "--to", "tum", "--plane", "xy", "--out", "flat.tum"}).out;
  EXPECT_THAT(said, AllOf(HasSubstr("height off it, RMS (m): 0.12500"), HasSubstr("roll RMS")));
  EXPECT_THAT(bytes_of("flat.tum"), HasSubstr("1403636579.763555527 1 2 0 0 0 0 1\n"));
}

TEST_F(Commands, ConvertWritesGraphsThatSolveAlike) {
  write("g.g2o", "FIX 0\n" + square_graph(40, 3));
  EXPECT_THAT(fathom_done({"convert", "g.g2o", "--to", "toro", "--out", "g.graph"}).out,
              HasSubstr("left out: 1 line FIX, which TORO does not have"));
  EXPECT_THAT(bytes_of("g.graph"), AllOf(HasSubstr("EDGE2 "), Not(HasSubstr("SE2"))));
  fathom_done({"convert", "g.graph", "--to", "g2o", "--out", "back.g2o"});
  for (const std::string name : {"g.g2o", "g.graph", "back.g2o"}) {
    fathom_done({"solve", name, "--out", name + ".out"});
  }
  EXPECT_EQ(bytes_of("g.g2o.out/trajectory.tum"), bytes_of("g.graph.out/trajectory.tum"));
  EXPECT_EQ(bytes_of("g.g2o.out/trajectory.tum"), bytes_of("back.g2o.out/trajectory.tum"));
}

TEST_F(Commands, ConvertSaysThatWhatRegistrationsShareIsLost) {
  write("g.g2o", "FIX 0\n" + square_graph(40, 3));
  const Arguments convert{"convert", "g.g2o", "--to", "g2o", "--out", "back.g2o"};
  EXPECT_THAT(fathom_done(convert).out, Not(HasSubstr("share")));
  write("g.shared", "");
  EXPECT_THAT(fathom_done(convert).out, HasSubstr("left out: g.shared, the errors that"));
  // Another graph's would be read with it; its own may stay.
  write("back.shared", "");
  EXPECT_THAT(refusal(convert), HasSubstr("back.shared: is of another graph"));
  EXPECT_THAT(fathom_done({"convert", "g.g2o", "--to", "toro", "--out", "g.graph"}).out,
              Not(HasSubstr("share")));
}

TEST_F(Commands, ConvertRefusesWhatItCannotDo) {
  write("t.csv", kEuroc);
  write("g.g2o", square_graph(40, 3));
  write("empty.tum", "# nothing\n");
  write("k.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  const auto refused = [&](const std::string& input, const std::string& to,
                           const Arguments& more = {}) {
    Arguments all{"convert", input, "--to", to, "--out", "out"};
    all.insert(all.end(), more.begin(), more.end());
    return refusal(all);
  };
  EXPECT_THAT(refused("g.g2o", "tum"), HasSubstr("g.g2o: is a pose graph"));
  EXPECT_THAT(refused("t.csv", "toro"), HasSubstr("t.csv: is no pose graph"));
  EXPECT_THAT(refused("none", "tum"), HasSubstr("none: cannot be opened"));
  EXPECT_THAT(refused("empty.tum", "kitti"), HasSubstr("empty.tum: holds no pose"));
  EXPECT_THAT(refused("t.csv", "tum", {"--from", "kitti"}), HasSubstr("t.csv:2: expected the 12"));
  EXPECT_THAT(refused("t.csv", "tum", {"--from", "csv"}),
              HasSubstr("--from: expected one of tum, kitti"));
  EXPECT_THAT(refused("t.csv", "tum", {"--plane", "zz"}),
              HasSubstr("expected one of xy, xz, yz, fit"));
  EXPECT_THAT(refused("t.csv", "tum", {"--plane", "fit"}), HasSubstr("lie on a line"));
  EXPECT_THAT(refused("g.g2o", "toro", {"--plane", "xy"}), HasSubstr("--plane: is for traj"));
  EXPECT_THAT(refused("k.txt", "tum", {"--times-out", "times"}), HasSubstr("has no times"));
  EXPECT_THAT(refused("t.csv", "tum", {"--times", "k.txt"}), HasSubstr("has times of its own"));
  EXPECT_THAT(refused("t.csv", "kitti", {"--times-out", "out"}), HasSubstr("the same file"));
  EXPECT_THAT(refusal({"convert", "t.csv", "--to", "tum", "--out", "t.csv"}), HasSubstr("t.csv"));
  ASSERT_EQ(::mkfifo(path("pipe").c_str(), 0600), 0);
  EXPECT_THAT(refusal({"convert", "t.csv", "--to", "tum", "--out", "pipe"}),
              HasSubstr("pipe: is a device or a pipe, not a file"));
  EXPECT_THAT(refusal({"convert", "t.csv", "--to", "toto", "--out", "o"}), HasSubstr("--to"));
  EXPECT_THAT(refusal({"convert", "t.csv", "--out", "o"}), HasSubstr("'--to' is missing: "));
}

}  // namespace
}  // namespace fathom::test

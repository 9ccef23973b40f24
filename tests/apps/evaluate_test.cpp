// evaluate: the errors of a written trajectory.

#include <regex>

#include <gmock/gmock.h>

#include "apps/commands.hpp"
#include "harness/small_config.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Commands, EvaluateAgreesWithTheRun) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out"});
  const Ended ended = fathom_done({"evaluate", "out/trajectory.tum", "out/ground_truth.tum",
                                   "--step", "1", "--step", "3", "--distance", "1.5"});
  std::smatch found;
  ASSERT_TRUE(
      std::regex_search(ended.out, found, std::regex(R"(mean position error \(m\) +([0-9.e-]+))")));
  const double expected = json_of("out/metrics.json").at("mean_position_error_m");
  EXPECT_NEAR(std::stod(found[1]), expected, 1e-5 * expected);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("11 of 11 poses"), HasSubstr("3 poses"),
                               HasSubstr("1.50 m"), HasSubstr("alignment origin")));
}

TEST_F(Commands, EvaluateSaysOfASinglePoseThatItHasNoError) {
  write("estimate.tum", "0 1 2 0 0 0 0 1\n");
  write("reference.tum", "0 4 6 0 0 0 0 1\n1 5 6 0 0 0 0 1\n");
  for (const char* alignment : {"origin", "se2"}) {
    const std::string out =
        fathom_done({"evaluate", "estimate.tum", "reference.tum", "--alignment", alignment}).out;
    EXPECT_THAT(out, HasSubstr("no error can be given: alignment " + std::string(alignment)));
    EXPECT_THAT(out, Not(HasSubstr("mean position error")));
  }
  const std::vector<std::string> as_it_is{"evaluate", "estimate.tum", "reference.tum",
                                          "--alignment", "none"};
  EXPECT_TRUE(std::regex_search(fathom_done(as_it_is).out,
                                std::regex(R"(mean position error \(m\) +5\.0)")));
}

// The second and third pose have no reference.
TEST_F(Commands, EvaluateCountsThePairsThatSpanAGap) {
  std::string estimate;
  std::string reference;
  for (int i = 0; i < 6; ++i) {
    const std::string line = std::to_string(i) + " " + std::to_string(i) + " 0 0 0 0 0 1\n";
    estimate += line;
    if (i != 1 && i != 2) reference += line;
  }
  write("e.tum", estimate);
  write("r.tum", reference);
  const auto printed = [&](const std::string& of) {
    return fathom_done({"evaluate", "e.tum", of, "--step", "1", "--distance", "2"}).out;
  };
  EXPECT_THAT(printed("r.tum"), AllOf(HasSubstr("warning: 1 of 3 pairs over 1 pose lie further"),
                                      HasSubstr("warning: the reference has gaps")));
  EXPECT_THAT(printed("e.tum"), Not(HasSubstr("warning")));
}

std::string recorded(const std::string& name) {
  return std::string(FATHOM_SOURCE_DIR) + "/tests/evaluation/evo/" + name;
}

// The digits that evo prints (tests/evaluation/evo/figures.csv).
TEST_F(Commands, EvaluatePrintsWhatEvoDoes) {
  const auto printed = [&](const Arguments& arguments) {
    Arguments all{"evaluate"};
    all.insert(all.end(), arguments.begin(), arguments.end());
    return fathom_done(all).out;
  };
  const auto row = [](const std::string& name, const std::string& digits) {
    return ::testing::ContainsRegex(name + " +" + digits + "[0-9]*\n");
  };
  const std::string flat = recorded("flat_estimate.tum");
  const std::string truth = recorded("flat_reference.tum");
  EXPECT_THAT(printed({flat, truth, "--align", "se2"}),
              AllOf(row("ATE RMSE .m.", "0.054673"), row("mean position error .m.", "0.050134"),
                    row("median position error .m.", "0.05264"),
                    row("largest position error .m.", "0.084468"),
                    row("heading RMSE .rad.", "0.062211"), Not(HasSubstr("left out"))));
  const std::string space =
      printed({recorded("space_estimate.tum"), recorded("space_reference.csv"), "--align", "none"});
  EXPECT_THAT(space, AllOf(row("ATE RMSE .m.", "2.13979"), HasSubstr("2.68587 m"),
                           row("height off it, RMS .m. +[0-9.]+", "0.10492")));
  const std::string kitti =
      printed({recorded("kitti_estimate.txt"), recorded("kitti_reference.txt"), "--align", "none"});
  EXPECT_THAT(kitti, AllOf(row("ATE RMSE .m.", "2.25829"), HasSubstr("2.73863 m"),
                           HasSubstr("paired by index"), row("plane +xz", "xz")));
}

TEST_F(Commands, EvaluateAlignsYawAndNamesABetterPlane) {
  const Arguments pair{"evaluate", recorded("kitti_estimate.txt"), recorded("kitti_reference.txt"),
                       "--alignment"};
  const auto printed = [&](const Arguments& more) {
    Arguments all = pair;
    all.insert(all.end(), more.begin(), more.end());
    return fathom_done(all).out;
  };
  EXPECT_THAT(printed({"yaw"}), AllOf(HasSubstr("alignment yaw"), Not(HasSubstr("warning"))));
  EXPECT_THAT(printed({"se2", "--plane", "fit"}), HasSubstr("fit: xz tilted by 0.01"));
  EXPECT_THAT(printed({"se2", "--plane", "xy"}), HasSubstr("--plane xz may be meant"));
}

TEST_F(Commands, EvaluateReadsTimesOfKittiAndAnOffset) {
  fathom_done({"convert", recorded("space_estimate.tum"), "--to", "kitti", "--out", "e.txt",
               "--times-out", "times.txt"});
  const std::string reference = recorded("space_reference.csv");
  // Without an alignment no error is next to zero, where rounding would show.
  const auto printed = [&](const std::string& estimate, const Arguments& more) {
    Arguments all{"evaluate", estimate, reference, "--plane", "xy", "--align", "none"};
    all.insert(all.end(), more.begin(), more.end());
    return fathom_done(all).out;
  };
  EXPECT_EQ(printed("e.txt", {"--times", "times.txt"}),
            printed(recorded("space_estimate.tum"), {}));
  EXPECT_THAT(refusal({"evaluate", "e.txt", reference}), HasSubstr("--times FILE names a file"));
  EXPECT_THAT(refusal({"evaluate", reference, reference, "--times", "times.txt"}),
              HasSubstr("only KITTI poses need times"));
  write("short.txt", "1 0 0 0 0 1 0 0 0 0 1 0\n");
  EXPECT_THAT(refusal({"evaluate", "short.txt", "e.txt"}),
              HasSubstr("has 1 poses, e.txt 58: without times they are paired by index"));
  EXPECT_THAT(refusal({"evaluate", "e.txt", "e.txt", "--time-offset", "1"}),
              HasSubstr("neither trajectory has times"));
  write("now.tum", "1000.5 0 0 0 0 0 0 1\n1001.5 1 0 0 0 0 0 1\n");
  write("then.tum", "0.25 0 0 0 0 0 0 1\n1.25 1 0 0 0 0 0 1\n");
  EXPECT_THAT(
      refusal({"evaluate", "then.tum", "now.tum"}),
      HasSubstr("it is from 0.250000000 to 1.250000000 s, the reference from 1000.500000000 "
                "to 1001.500000000 s; --time-offset 1000.25 lets both begin together"));
  EXPECT_THAT(refusal({"evaluate", "then.tum", "now.tum", "--time-offset", "5"}),
              HasSubstr("--time-offset 1000.25 lets"));
  EXPECT_THAT(fathom_done({"evaluate", "then.tum", "now.tum", "--time-offset", "1000.25"}).out,
              HasSubstr("2 of 2 poses"));
}

}  // namespace
}  // namespace fathom::test

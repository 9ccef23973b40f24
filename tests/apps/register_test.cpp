// register: the motion of two frames, what it prints of it, and its pictures.

#include <filesystem>
#include <regex>

#include <gmock/gmock.h>
#include <opencv2/core.hpp>

#include "apps/commands.hpp"
#include "harness/small_config.hpp"
#include "support/pictures.hpp"

namespace fathom::test {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

TEST_F(Commands, RegisterFindsTheMotionOfTwoFrames) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  const std::string pictures = "data/mav0/cam0/data/";
  const Ended ended =
      fathom_done({"register", pictures + "0.png", pictures + "500000000.png", "--config", "c.yaml",
                   "--altitude-a", "2", "--altitude-b", "2.03", "--out", "out"});
  std::smatch found;
  ASSERT_TRUE(std::regex_search(ended.out, found, std::regex(R"(x +(-?[0-9.]+) m)"))) << ended.out;
  EXPECT_NEAR(std::stod(found[1]), 0.25, 0.03);  // 0.5 m/s, two pictures a second
  for (const char* line :
       {R"(^found: pose of B in the frame of A)", R"(\n  y +-?[0-9.]+ m +\+- 0\.)",
        R"(\n  heading +-?[0-9.]+ rad \+- 0\.)",
        R"(\n  rms of the pairs +0\.[0-9]+ m, [0-9.]+ pixels)",
        R"(\n  features +[0-9]+ in A, [0-9]+ in B)", R"(\n  matches +[0-9]+, each distinct)",
        R"(\n  nearest pairs +[0-9]+ agree, in [0-9]+ places)",
        R"(\n  other motions +[0-9]+ places at most)",
        R"(\n  by chance +(below 1e-300|[0-9.]+e-[0-9]+), at most 1e-07 is allowed)",
        R"(\n  scale +[01]\.[0-9]+ \+- 0\.[0-9]+, as the altitudes say)"}) {
    EXPECT_TRUE(std::regex_search(ended.out, std::regex(line))) << line << "\n" << ended.out;
  }
  expect_picture("out/matches_raw.png");
  expect_picture("out/matches_accepted.png");
  expect_picture("out/overlay.png");
}

TEST_F(Commands, HelpGivesWhatMustBeGivenNoDefault) {
  const std::string help = fathom_done({"register", "--help"}).out;
  EXPECT_THAT(help, AllOf(HasSubstr("--altitude-a"), Not(HasSubstr("M=0"))));
}

TEST_F(Commands, RegisterSaysThatAltitudesMayBeWrong) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  const std::string pictures = "data/mav0/cam0/data/";
  const Ended ended =
      fathom_done({"register", pictures + "0.png", pictures + "500000000.png", "--config", "c.yaml",
                   "--altitude-a", "2", "--altitude-b", "2.11", "--out", "out"});
  EXPECT_THAT(ended.out, HasSubstr(", not applied: the altitudes may be wrong\n"));
}

// The sigma of x, in metres.
double sigma_of_x(const Ended& ended) {
  std::smatch found;
  const bool is_there =
      std::regex_search(ended.out, found, std::regex(R"(\n  x +-?[0-9.]+ m +\+- ([0-9.]+))"));
  EXPECT_TRUE(is_there) << ended.out;
  return is_there ? std::stod(found[1]) : 0.0;
}

TEST_F(Commands, RegisterKnowsWhatTheAltimeterStates) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  write("folder.yaml",
        "dataset: {type: image_folder, path: data}\n"
        "front_end.covariance.tilt_sigma_rad: 0\n");
  const auto found = [&](const std::string& sensor) {
    write("data/mav0/altimeter0/sensor.yaml", sensor);
    const std::string pictures = "data/mav0/cam0/data/";
    return sigma_of_x(
        fathom_done({"register", pictures + "0.png", pictures + "500000000.png", "--config",
                     "folder.yaml", "--altitude-a", "2", "--altitude-b", "2.03", "--out", "out"}));
  };
  const double without_m = found("scale: 1\n");
  EXPECT_GT(found("sigma_absolute: 0.05\n"), 2.0 * without_m);
  EXPECT_GT(found("sigma_relative: 0.05\n"), 3.0 * without_m);
}

TEST_F(Commands, RegisterByInliersSaysHowManyAreNeeded) {
  write("c.yaml", std::string(kSmallSurvey) + "front_end.decision.method: inliers\n");
  fathom_done({"simulate", "c.yaml", "--out", "data"});
  const std::string pictures = "data/mav0/cam0/data/";
  const Ended ended =
      fathom_done({"register", pictures + "0.png", pictures + "500000000.png", "--config", "c.yaml",
                   "--altitude-a", "2", "--altitude-b", "2.03", "--out", "out"});
  EXPECT_THAT(ended.out, HasSubstr(" of them, 12 are needed; in 8 or more places, 8 are needed"));
  EXPECT_THAT(ended.out, Not(HasSubstr("by chance")));
}

TEST_F(Commands, RegisterWithoutAMatchIsStatusOne) {
  for (const std::string name : {"a.png", "b.png"}) {
    cv::Mat noise(120, 160, CV_8UC1);
    cv::RNG(name == "a.png" ? 1 : 2).fill(noise, cv::RNG::UNIFORM, 0, 255);
    write_picture(path(name), noise);
  }
  write("c.yaml", kSmallSurvey);
  const Ended ended = fathom({"register", "a.png", "b.png", "--config", "c.yaml", "--altitude-a",
                              "2", "--altitude-b", "2", "--out", "out"});
  EXPECT_EQ(ended.status, 1);
  EXPECT_THAT(ended.out, AllOf(HasSubstr("not found: "), HasSubstr("\n  nearest pairs"),
                               HasSubstr("\n  by chance"), Not(HasSubstr("scale"))));
  EXPECT_EQ(ended.err, "");
  expect_picture("out/matches_raw.png");
  expect_picture("out/matches_accepted.png");
  EXPECT_FALSE(std::filesystem::exists(path("out/overlay.png")));
}

}  // namespace
}  // namespace fathom::test

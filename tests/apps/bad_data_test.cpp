// Data that cannot be used: graphs, image folders, pictures, trajectories.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "datasets/folder_fixture.hpp"
#include "support/pictures.hpp"

namespace fathom::test {
namespace {

namespace fs = std::filesystem;
using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::StartsWith;

class BadData : public CommandLine {};

TEST_F(BadData, AFaultyGraphIsRefusedAtItsLine) {
  const std::vector<std::pair<std::string, std::string>> cases{
      {"EDGE_SE2 0 1 1 0 0 1 0\n", "g.g2o:4: "},
      {"VERTEX_SE2 2 1 0\n", "g.g2o:4: "},
      {"EDGE_SE3 0 1 1 0 0 1 0 0 1 0 1\n", "g.g2o:4: "},
      {"EDGE_SE2 0 1 nan 0 0 1 0 0 1 0 1\n", "g.g2o:4: "},
      {"EDGE_SE2 0 1 1 0 0 1 2 0 1 0 1\n", "positive definite"},
      {"EDGE_SE2 0 1 1 0 0 1 0 0 1 0 -1\n", "positive definite"},
      {"EDGE_SE2 1 1 1 0 0 1 0 0 1 0 1\n", "g.g2o:4: "},
      {"EDGE_SE2 1 7 1 0 0 1 0 0 1 0 1\n", "7"},
      {"VERTEX_SE2 2 2 0 0\n", "the graph has 2 components"},
      {"FIX 1\n", "g.g2o:4: "}};
  for (const auto& [line, message] : cases) {
    write("g.g2o", kTwoPoses + line);
    EXPECT_THAT(refusal({"solve", "g.g2o", "--out", "out"}),
                AllOf(StartsWith("g.g2o:"), HasSubstr(message)))
        << line;
    const Ended checked = fathom({"check", "g.g2o"});
    EXPECT_EQ(checked.status, 2) << line;
    EXPECT_THAT(checked.out, HasSubstr("fault: g.g2o:")) << line;
    EXPECT_THAT(checked.err, HasSubstr("(1 fault in all)")) << line;
  }
}

TEST_F(BadData, AnEmptyOrMissingGraphIsRefused) {
  EXPECT_THAT(refusal({"solve", "none.g2o", "--out", "out"}), HasSubstr("none.g2o"));
  EXPECT_THAT(refusal({"check", "none.g2o"}), HasSubstr("none.g2o"));
  for (const std::string text : {"", "# nothing\n", "\n\n"}) {
    write("g.g2o", text);
    EXPECT_THAT(refusal({"solve", "g.g2o", "--out", "out"}), HasSubstr("g.g2o")) << text;
  }
  EXPECT_THAT(refusal({"solve", ".", "--out", "out"}), HasSubstr("is a folder"));
}

class BadFolder : public BadData {
 protected:
  /// Runs and checks `data`, the image folder of the fixture as it now is; the refusal.
  std::string refused(const FolderFixture& fixture) const {
    fs::remove_all(path("data"));
    fs::copy(fixture.write(), path("data"), fs::copy_options::recursive);
    if (spoil) spoil(path("data") / "mav0");
    write("c.yaml",
          "dataset: {type: image_folder, path: data}\n"
          "front_end: {keyframes: {separation_frames: 1}}\n");
    return refusal({"run", "c.yaml", "--out", "out"});
  }

  std::function<void(const fs::path&)> spoil;
};

TEST_F(BadFolder, TheSoundOneRuns) {
  const FolderFixture fixture;
  fs::copy(fixture.write(), path("data"), fs::copy_options::recursive);
  write("c.yaml",
        "dataset: {type: image_folder, path: data}\n"
        "front_end: {keyframes: {separation_frames: 1}}\n");
  const Ended ended = fathom_done({"run", "c.yaml", "--out", "out"});
  EXPECT_THAT(ended.out, HasSubstr("3 frames"));
  EXPECT_EQ(json_of("out/metrics.json").at("outcome"), "converged");
}

TEST_F(BadFolder, TextsAreRefusedAtTheirLine) {
  const std::vector<std::tuple<std::string, std::string, std::string>> cases{
      {"cam0/data.csv", "#t,f\n0,a.png\n2000,b.png\n1000,c.png\n", "cam0/data.csv:4: "},
      {"cam0/data.csv", "#t,f\n0,a.png\n0,b.png\n", "cam0/data.csv:3: "},
      {"cam0/data.csv", "#t,f\n", "cam0/data.csv"},
      {"cam0/data.csv", "", "cam0/data.csv"},
      {"cam0/data.csv", "#t,f\n0,a.png\n1000,none.png\n", "none.png"},
      {"cam0/data.csv", "#t,f\nzero,a.png\n", "cam0/data.csv:2: "},
      {"cam0/sensor.yaml", "resolution: [8, 6]\n", "cam0/sensor.yaml"},
      {"cam0/sensor.yaml", ": [\n", "cam0/sensor.yaml"},
      {"altimeter0/data.csv", "#t,a\n0,2\n1000,0\n2000,3\n", "altimeter0/data.csv:3: "},
      {"altimeter0/data.csv", "#t,a\n0,2\n1000,-1\n2000,3\n", "altimeter0/data.csv:3: "},
      {"altimeter0/data.csv", "#t,a\n0,2\n1000,nan\n2000,3\n", "altimeter0/data.csv:3: "},
      {"altimeter0/data.csv", "#t,a\n0,2\n1000,2\n", "altimeter0/data.csv"},
      {"altimeter0/data.csv", "#t,a\n0,2\n2000,2\n1000,3\n", "altimeter0/data.csv:4: "},
      {"odometry0/data.csv", "#t\n0,0,0,0,0,0,0\n1000,1,0,0,0,0,0\n2000,2,0,0,0,0,0\n",
       "odometry0/data.csv:3: "},
      {"odometry0/data.csv", "#t\n0,0,0,0,0,0,0\n1000,1\n", "odometry0/data.csv:3: "}};
  for (const auto& [name, text, message] : cases) {
    FolderFixture fixture;
    fixture.files[name] = text;
    EXPECT_THAT(refused(fixture), HasSubstr(message)) << name << "\n" << text;
  }
}

TEST_F(BadFolder, LimitsAreThoseOfTheEnvironment) {
  const FolderFixture fixture;
  const auto refused_with = [&](const std::string& limits) {
    surroundings_.environment = {{"FATHOM_LIMITS", limits}};
    return refused(fixture);
  };
  EXPECT_THAT(refused_with("csv_rows=2"),
              HasSubstr("cam0/data.csv:4: has too many rows; the limit is 2; FATHOM_LIMITS=csv_rows"
                        "=N sets another"));
  EXPECT_THAT(refused_with("csv_rows=3,picture_pixels=47"),
              HasSubstr("a.png: has 8 x 6 pixels in all; the limit is 47; "));
  for (const char* const wrong : {"csv_row=2", "csv_rows", "csv_rows=0", "csv_rows=1e6", "=2"}) {
    EXPECT_THAT(refused_with(wrong), HasSubstr("FATHOM_LIMITS: expected csv_rows=N, ")) << wrong;
  }
  EXPECT_THAT(refused_with("picture_pixels=1073741825"),
              HasSubstr("FATHOM_LIMITS: picture_pixels: expected at most 1073741824"));
}

TEST_F(BadFolder, PicturesAreRefusedByName) {
  const FolderFixture fixture;
  // The last picture is read in the background.
  for (const std::string name : {"a.png", "b.png", "c.png"}) {
    spoil = [&](const fs::path& mav0) { fs::remove(mav0 / "cam0" / "data" / name); };
    EXPECT_THAT(refused(fixture), HasSubstr(name));
    spoil = [&](const fs::path& mav0) { std::ofstream(mav0 / "cam0" / "data" / name) << "no"; };
    EXPECT_THAT(refused(fixture), HasSubstr(name));
    spoil = [&](const fs::path& mav0) { fs::resize_file(mav0 / "cam0" / "data" / name, 60); };
    EXPECT_THAT(refused(fixture), HasSubstr(name));
    spoil = [&](const fs::path& mav0) {
      write_picture(mav0 / "cam0" / "data" / name, cv::Mat::zeros(5, 8, CV_8UC1));
    };
    EXPECT_THAT(refused(fixture), HasSubstr(name));
  }
}

TEST_F(BadFolder, MissingPartsAreRefused) {
  const FolderFixture fixture;
  for (const std::string part : {"altimeter0", "cam0", "cam0/sensor.yaml", "cam0/data.csv"}) {
    spoil = [&](const fs::path& mav0) { fs::remove_all(mav0 / part); };
    EXPECT_THAT(refused(fixture), HasSubstr(part.substr(0, 4))) << part;
  }
  spoil = [&](const fs::path& mav0) { fs::remove_all(mav0); };
  EXPECT_THAT(refused(fixture), HasSubstr("data"));
  EXPECT_THAT(refusal({"check", "data"}), HasSubstr("data"));
}

TEST_F(BadData, RegisterRefusesWhatIsNoPicture) {
  write("a.png", "no picture");
  write("c.yaml", "dataset: {camera: {width: 8, height: 6}}\n");
  const Arguments altitudes{"--altitude-a", "1", "--altitude-b", "1", "--out", "out"};
  const auto refused = [&](Arguments arguments) {
    arguments.insert(arguments.end(), altitudes.begin(), altitudes.end());
    return refusal(arguments);
  };
  EXPECT_THAT(refused({"register", "a.png", "a.png"}), HasSubstr("a.png"));
  EXPECT_THAT(refused({"register", "none.png", "a.png"}), HasSubstr("none.png"));
  write_picture(path("b.png"), cv::Mat::zeros(5, 8, CV_8UC1));
  EXPECT_THAT(refused({"register", "b.png", "b.png", "--config", "c.yaml"}),
              HasSubstr("b.png: is 8 x 5 pixels, the camera of --config 8 x 6"));
  EXPECT_THAT(refused({"register", "b.png", "b.png", "--config", "none.yaml"}),
              HasSubstr("none.yaml"));
}

TEST_F(BadData, EvaluateRefusesWhatIsNoTrajectory) {
  write("good.tum", "0 0 0 0 0 0 0 1\n1 1 0 0 0 0 0 1\n");
  write("later.tum", "100 0 0 0 0 0 0 1\n");
  write("short.tum", "0 0 0 0 0 0 0 1\n1 1 0\n");
  write("back.tum", "1 0 0 0 0 0 0 1\n0 1 0 0 0 0 0 1\n");
  write("empty.tum", "# nothing\n");
  const auto refused = [&](const std::string& name) {
    return refusal({"evaluate", "good.tum", name});
  };
  EXPECT_THAT(refused("none.tum"), HasSubstr("none.tum: cannot be opened"));
  EXPECT_THAT(refused("short.tum"), HasSubstr("short.tum:2: "));
  EXPECT_THAT(refused("back.tum"), HasSubstr("back.tum:2: "));
  EXPECT_THAT(refused("later.tum"), HasSubstr("no pose is within 0.01"));
  EXPECT_THAT(refused("empty.tum"), HasSubstr("no pose is within"));
  EXPECT_THAT(refusal({"evaluate", "good.tum", "good.tum", "--alignment", "sim3"}),
              HasSubstr("expected one of none, origin, se2, yaw"));
  EXPECT_THAT(refusal({"check", "empty.tum"}), HasSubstr("holds no pose"));
}

}  // namespace
}  // namespace fathom::test

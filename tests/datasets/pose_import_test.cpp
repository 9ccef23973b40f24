// COLMAP models and KITTI poses as a reference: a planar path put into their conventions comes
// back.

#include <cmath>
#include <fstream>

#include <Eigen/Geometry>
#include <gmock/gmock.h>

#include "bag_fixture.hpp"
#include "fathom/core/text.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "folder_fixture.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

std::vector<Pose> path() {
  std::vector<Pose> poses;
  for (int i = 0; i < 12; ++i) poses.push_back({0.7 * i, 0.02 * i * i, wrap_angle(0.3 * i)});
  return poses;
}

/// A line of images.txt and its points: a camera that looks down on the floor, 2 m above it,
/// forward at the heading of the pose, in a world turned by `turn` and counted in units of `metres`
/// metres.
std::string image_line(int id, const Pose& pose, const Eigen::Quaterniond& turn, double metres,
                       const std::string& name, double altitude_m = 2.0) {
  const double c = std::cos(pose.theta);
  const double s = std::sin(pose.theta);
  Eigen::Matrix3d axes;
  axes.col(0) = Eigen::Vector3d(s, -c, 0.0);      // to starboard
  axes.col(1) = Eigen::Vector3d(-c, -s, 0.0);     // aft
  axes.col(2) = Eigen::Vector3d(0.0, 0.0, -1.0);  // down
  const Eigen::Matrix3d world_from_camera = turn.toRotationMatrix() * axes;
  const Eigen::Vector3d centre = turn * Eigen::Vector3d(pose.x, pose.y, altitude_m) / metres;
  const Eigen::Quaterniond q(Eigen::Matrix3d(world_from_camera.transpose()));
  const Eigen::Vector3d t = -(q * centre);
  std::string line = std::to_string(id);
  for (const double number : {q.w(), q.x(), q.y(), q.z(), t.x(), t.y(), t.z()}) {
    line += " " + exact(number);
  }
  return line + " 1 " + name + "\n\n";
}

class PoseImport : public ::testing::Test {
 protected:
  void write(const std::string& name, const std::string& text) const {
    std::filesystem::create_directories((folder_ / name).parent_path());
    std::ofstream(folder_ / name) << text;
  }
  std::string model_of(const std::vector<Pose>& poses, double metres) const {
    const Eigen::Quaterniond turn(Eigen::AngleAxisd(2.1, Eigen::Vector3d(1, -2, 0.5).normalized()));
    std::string text = "# images\n";
    for (std::size_t i = poses.size(); i-- > 0;) {
      char name[32];
      std::snprintf(name, sizeof name, "dive a/%03zu.png", i);
      text += image_line(static_cast<int>(i) + 1, poses[i], turn, metres, name);
    }
    return text;
  }
  std::vector<StampedPose> reference() const { return read_tum(folder_ / "reference.tum"); }

  test::TemporaryFolder folder_;
};

void expect_same_motions(const std::vector<StampedPose>& is, const std::vector<Pose>& was) {
  ASSERT_EQ(is.size(), was.size());
  for (std::size_t i = 0; i < was.size(); ++i) {
    const Pose expected = between(was.front(), was[i]);
    EXPECT_LT(test::distance(between(is.front().pose, is[i].pose), expected), 1e-9) << i;
  }
}

TEST_F(PoseImport, ColmapModelIsNeitherMirroredNorTurned) {
  write("model/images.txt", model_of(path(), 0.25));
  PoseImportOptions options;
  options.scale = 0.25;
  const ImportReport report = import_colmap(folder_ / "model", options, folder_.path());
  expect_same_motions(reference(), path());
  EXPECT_THAT(report.notes, Contains(HasSubstr("no scale")));
  EXPECT_THAT(report.facts, Contains(HasSubstr("12 poses of 12 images")));
}

TEST_F(PoseImport, ColmapCamerasAlongALineKeepTheirTurns) {
  std::vector<Pose> line;
  for (int i = 0; i < 5; ++i) line.push_back({1.0 * i, 0.0, 0.1 * i});
  write("model/images.txt", model_of(line, 1.0));
  const ImportReport report = import_colmap(folder_ / "model", {}, folder_.path());
  expect_same_motions(reference(), line);
  EXPECT_THAT(report.notes, Contains(HasSubstr("along a line")));
}

// The plane that fits best stands on edge there.
TEST_F(PoseImport, ColmapLegWhoseAltitudeChangesIsSeenFromAbove) {
  std::vector<Pose> leg;
  std::string model;
  for (int i = 0; i <= 20; ++i) {
    leg.push_back({5.0 * i, 0.3 * std::sin(1.7 * i), 0.0});
    model += image_line(i + 1, leg.back(), Eigen::Quaterniond::Identity(), 1.0,
                        "p" + std::to_string(100 + i) + ".png", 10.0 + 2.0 * std::cos(0.9 * i));
  }
  write("model/images.txt", model);
  import_colmap(folder_ / "model", {}, folder_.path());
  const std::vector<StampedPose> seen = reference();
  ASSERT_EQ(seen.size(), leg.size());
  for (std::size_t i = 0; i < leg.size(); ++i) {
    const Pose expected = between(leg.front(), leg[i]);
    EXPECT_NEAR(seen[i].pose.x, expected.x, 0.1) << i;
    EXPECT_NEAR(seen[i].pose.y, expected.y, 0.02) << i;
  }
}

TEST_F(PoseImport, ColmapTakesTimesMountingAndScaleOfTheSurvey) {
  const SimulatedSurvey survey(test::full_survey(), 6);
  write_image_folder(survey, folder_ / "survey");
  const CameraModel& camera = survey.camera().model();
  const Pose mount{camera.mount_x_m, camera.mount_y_m, camera.mount_yaw_rad};
  const Eigen::Quaterniond turn(Eigen::AngleAxisd(0.4, Eigen::Vector3d::UnitX()));
  std::string text;
  std::vector<Pose> truth;
  for (std::size_t i = 0; i < survey.size(); ++i) {
    truth.push_back(*survey.info(i).ground_truth);
    text += image_line(static_cast<int>(i) + 1, compose(truth.back(), mount), turn, 3.0,
                       std::to_string(survey.info(i).time_ns) + ".png");
  }
  write("model/images.txt", text);
  PoseImportOptions options;
  options.survey = folder_ / "survey";
  options.scale = 3.0;
  const ImportReport report = import_colmap(folder_ / "model", options, folder_.path());
  expect_same_motions(reference(), truth);
  EXPECT_EQ(reference().back().time_ns, survey.info(survey.size() - 1).time_ns);
  EXPECT_THAT(report.notes, Contains(HasSubstr("by the odometry of the survey one unit is")));
}

// The camera goes another way than the body where the vehicle turns: here it stays in its place.
TEST_F(PoseImport, ColmapScaleIsOfTheCamerasWay) {
  test::FolderFixture fixture;
  fixture.files["cam0/sensor.yaml"] += "mounting: {x: 1, y: 0, yaw: 0}\n";
  fixture.files["odometry0/data.csv"] =
      "#t,x,y,theta,vx,vy,vt\n0,0,0,0,0,0,0\n1000,1,1,-1.5707963267948966,1,1,1\n"
      "2000,3,1,-1.5707963267948966,1,1,1\n";
  PoseImportOptions options;
  options.survey = fixture.write();
  const auto turn = Eigen::Quaterniond::Identity();
  write("model/images.txt", image_line(1, {0, 0, 0}, turn, 1.0, "a.png") +
                                image_line(2, {0, 0, 0}, turn, 1.0, "b.png") +
                                image_line(3, {0.5, 0, 0}, turn, 1.0, "c.png"));
  const ImportReport report = import_colmap(folder_ / "model", options, folder_.path());
  EXPECT_THAT(report.notes, Contains(HasSubstr("by the odometry of the survey one unit is 4 m")));
}

TEST_F(PoseImport, ColmapErrorsAreOneLine) {
  const auto why = [&](const PoseImportOptions& options) {
    return test::input_error_of([&] { import_colmap(folder_ / "model", options, folder_.path()); });
  };
  write("model/images.txt", "# nothing\n");
  EXPECT_THAT(why({}), HasSubstr("has no images"));
  write("model/images.txt", "1 1 0 0 0 0 0 0 1\n\n");
  EXPECT_THAT(why({}), HasSubstr("images.txt:1: expected IMAGE_ID"));
  write("model/images.txt", "1 2 0 0 0 0 0 0 1 a.png\n\n");
  EXPECT_THAT(why({}), HasSubstr("of length 1"));
  write("model/images.txt", model_of(path(), 1.0));
  write_image_folder(SimulatedSurvey(test::small_survey(), 2), folder_ / "survey");
  PoseImportOptions options;
  options.survey = folder_ / "survey";
  EXPECT_THAT(why(options), HasSubstr("none of its images"));
}

// The camera of KITTI looks ahead: x to starboard, y down, z forward.
std::string kitti_line(const Pose& pose) {
  const double c = std::cos(pose.theta);
  const double s = std::sin(pose.theta);
  std::string line;
  for (const double number : {c, 0.0, -s, -pose.y, 0.0, 1.0, 0.0, 0.0, s, 0.0, c, pose.x}) {
    line += (line.empty() ? "" : " ") + exact(number);
  }
  return line + "\n";
}

TEST_F(PoseImport, KittiPosesComeBackWithTheirTimes) {
  std::string poses;
  std::string times;
  for (std::size_t i = 0; i < path().size(); ++i) {
    poses += kitti_line(path()[i]);
    times += number_text(0.5 * static_cast<double>(i)) + "\n";
  }
  write("poses.txt", poses);
  write("times.txt", times);
  EXPECT_EQ(import_kind(folder_ / "poses.txt"), ImportKind::kitti);
  PoseImportOptions options;
  options.times = folder_ / "times.txt";
  import_kitti(folder_ / "poses.txt", options, folder_.path());
  expect_same_motions(reference(), path());
  EXPECT_EQ(reference()[3].time_ns, 1'500'000'000);
}

TEST_F(PoseImport, KittiErrorsAreOneLine) {
  const auto why = [&](const PoseImportOptions& options) {
    return test::input_error_of(
        [&] { import_kitti(folder_ / "poses.txt", options, folder_.path()); });
  };
  write("poses.txt", kitti_line({}) + kitti_line({1, 0, 0}));
  EXPECT_THAT(why({}), AllOf(HasSubstr("--times FILE"), HasSubstr("--survey DIR")));
  PoseImportOptions options;
  options.times = folder_ / "times.txt";
  write("times.txt", "0\n");
  EXPECT_THAT(why(options), HasSubstr("has 2 poses for 1 times"));
  write("times.txt", "1\n1\n");
  EXPECT_THAT(why(options), HasSubstr("times.txt:2: 2 poses have 1 time stamp between them"));
  write("times.txt", "1700000000000000000\n1700000001000000000\n");
  EXPECT_THAT(why(options), HasSubstr("it seems, nanoseconds"));
  write("poses.txt", kitti_line({}) + "1 2 3\n");
  EXPECT_THAT(why(options), HasSubstr("poses.txt:2: expected the 12 numbers"));
}

TEST_F(PoseImport, WhatIsNotReadIsNamed) {
  const auto why = [&](const std::string& name) {
    return test::input_error_of([&] { import_kind(folder_ / name); });
  };
  write("bag/metadata.yaml", "rosbag2_bagfile_information: {storage_identifier: other}\n");
  EXPECT_THAT(test::input_error_of([&] { import_bag(folder_ / "bag", {}, folder_ / "out"); }),
              AllOf(HasSubstr("expected sqlite3 or mcap"), HasSubstr("ros2 bag convert")));
  write("zip/metadata.yaml",
        "rosbag2_bagfile_information: {storage_identifier: sqlite3, compression_format: zstd}\n");
  EXPECT_THAT(test::input_error_of([&] { import_bag(folder_ / "zip", {}, folder_ / "out"); }),
              AllOf(HasSubstr("compressed"), HasSubstr("ros2 bag convert")));
  write("binary/images.bin", "x");
  EXPECT_THAT(why("binary"), HasSubstr("colmap model_converter"));
  write("notes.txt", "hello");
  EXPECT_THAT(why("notes.txt"), HasSubstr("expected a bag of ROS 1"));
  EXPECT_THAT(why("nowhere"), HasSubstr("is not there"));
}

}  // namespace
}  // namespace fathom

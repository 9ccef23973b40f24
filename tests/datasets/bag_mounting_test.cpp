// Where the camera is in the body, by the static transforms of a bag.

#include <cmath>

#include <gmock/gmock.h>

#include "bag_fixture.hpp"

namespace fathom {
namespace {

using test::FramePlace;
using test::kBagFrame;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

using Quaternion = std::array<double, 4>;

// An optical frame that looks straight down, the top of its picture `yaw` from forward.
Quaternion looking_down(double yaw, double tilt = 0.0) {
  Eigen::Matrix3d axes;
  axes.col(0) = Eigen::Vector3d(std::sin(yaw), -std::cos(yaw), 0.0);
  axes.col(1) = Eigen::Vector3d(-std::cos(yaw), -std::sin(yaw), 0.0);
  axes.col(2) = Eigen::Vector3d(0.0, 0.0, -1.0);
  const Eigen::Quaterniond q(axes * Eigen::AngleAxisd(tilt, Eigen::Vector3d::UnitX()));
  return {q.x(), q.y(), q.z(), q.w()};
}

class BagMounting : public test::BagTest {
 protected:
  // Two pictures, an altitude and an odometry of base_link at each, and tf.
  void write(const std::vector<std::vector<FramePlace>>& messages,
             const std::string& topic = "/tf_static") const {
    const auto bag = writer();
    for (std::int64_t i = 0; i < 2; ++i) {
      const test::Stamps stamps{test::kBegin + i * test::kSecond, test::kBegin + i * test::kSecond};
      test::RawImage image;
      image.height = 6;
      image.width = image.step = 8;
      image.data.assign(48, 50);
      bag->image("/cam/image", stamps, image);
      test::CameraInformation info;
      info.width = 8;
      info.height = 6;
      info.K = {10.0, 0, 3.5, 0, 10.0, 2.5, 0, 0, 1};
      bag->camera_info("/cam/camera_info", stamps, info);
      bag->point("/altitude", stamps, {0, 0, 2});
      test::BodyPose pose;
      pose.position = {0.1 * static_cast<double>(i), 0.0, 0.0};
      bag->odometry("/odom", stamps, pose);
      if (i < static_cast<std::int64_t>(messages.size())) {
        bag->transforms(topic, stamps, messages[static_cast<std::size_t>(i)]);
      }
    }
  }
  CameraModel camera() const { return ImageFolder(out()).camera().model(); }
};
INSTANTIATE_TEST_SUITE_P(Bags, BagMounting, ::testing::Values(1, 2), test::generation);

// The camera is on an arm that is turned by a quarter to port.
const FramePlace kArm{"base_link", "arm", {0.5, 0.2, -0.1}, {0, 0, std::sqrt(0.5), std::sqrt(0.5)}};
const FramePlace kOnArm{"arm", kBagFrame, {0.3, 0.0, 0.0}, looking_down(0.4)};

TEST_P(BagMounting, IsTakenFromAChainOfStaticTransforms) {
  write({{kArm}, {kOnArm}});
  const ImportReport report = import();
  EXPECT_NEAR(camera().mount_x_m, 0.5, 1e-9);
  EXPECT_NEAR(camera().mount_y_m, 0.5, 1e-9);
  EXPECT_NEAR(camera().mount_yaw_rad, 0.4 + std::acos(0.0), 1e-9);
  EXPECT_THAT(report.notes,
              Contains(HasSubstr("mounting of the camera from tf, 'odd length' in 'base_link': x "
                                 "0.5 m, y 0.5 m, yaw 1.971 rad")));
  EXPECT_THAT(report.notes, Not(Contains(HasSubstr("at the body's origin"))));
}

TEST_P(BagMounting, IsThatOfTheFlagsWhereOneIsGiven) {
  write({{kArm, kOnArm}});
  BagImportOptions options;
  options.mount_x_m = 0.7;
  const ImportReport report = import(options);
  EXPECT_EQ(camera().mount_x_m, 0.7);
  EXPECT_EQ(camera().mount_y_m, 0.0);
  EXPECT_THAT(report.notes, Not(Contains(HasSubstr("from tf"))));
}

// Static by what it says, not by its topic: ROS 1 sends such transforms again and again.
TEST_P(BagMounting, ATransformThatMovesIsNone) {
  write({{kArm, kOnArm}, {kArm, kOnArm}}, "/tf");
  import();
  EXPECT_NEAR(camera().mount_x_m, 0.5, 1e-9);
  std::filesystem::remove_all(out());
  std::filesystem::remove(bag());
  FramePlace moved = kArm;
  moved.translation[0] += 0.01;
  write({{kArm, kOnArm}, {moved, kOnArm}}, "/tf");
  EXPECT_THAT(import().notes, Contains(HasSubstr("tf does not say where the camera's frame")));
  EXPECT_EQ(camera().mount_x_m, 0.0);
}

TEST_P(BagMounting, ACameraThatLooksElsewhereIsNotMountedByTf) {
  FramePlace ahead = kOnArm;
  ahead.rotation = looking_down(0.0, 1.5);
  write({{kArm, ahead}});
  EXPECT_THAT(import().notes, Contains(HasSubstr("points 1.5 rad off straight down")));
  EXPECT_EQ(camera().mount_x_m, 0.0);
}

TEST_P(BagMounting, ASmallTiltIsSaid) {
  FramePlace tilted = kOnArm;
  tilted.rotation = looking_down(0.4, 0.05);
  write({{kArm, tilted}});
  EXPECT_THAT(import().notes, Contains(HasSubstr("taken for level, it is 0.05 rad off")));
}

// Transforms in a circle end the search.
TEST_P(BagMounting, ACircleOfFramesIsNoChain) {
  write({{{"a", kBagFrame, {}, looking_down(0)}, {kBagFrame, "a", {}, looking_down(0)}}});
  EXPECT_THAT(import().notes, Contains(HasSubstr("tf does not say where")));
}

}  // namespace
}  // namespace fathom

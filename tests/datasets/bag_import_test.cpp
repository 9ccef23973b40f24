// A survey written as a bag by what Fathom does not read with comes back as it was.

#include <gmock/gmock.h>

#include "bag_fixture.hpp"
#include "fathom/core/files.hpp"
#include "support/planar.hpp"

namespace fathom {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class BagRoundTrip : public test::BagTest {};
INSTANTIATE_TEST_SUITE_P(Bags, BagRoundTrip, ::testing::Values(1, 2), test::generation);

TEST_P(BagRoundTrip, SurveyComesBack) {
  const SimulatedSurvey survey(test::full_survey(), 6);
  const test::SurveyBag how;
  write_bag(survey, how);
  const CameraModel& camera = survey.camera().model();
  BagImportOptions options;
  options.mount_x_m = camera.mount_x_m;
  options.mount_y_m = camera.mount_y_m;
  options.mount_yaw_rad = camera.mount_yaw_rad;
  import(options);
  const ImageFolder read(out());
  const CameraModel& model = read.camera().model();
  EXPECT_EQ(model.fx, camera.fx);
  EXPECT_EQ(model.fy, camera.fy);
  EXPECT_EQ(model.cx, camera.cx);
  EXPECT_EQ(model.cy, camera.cy);
  EXPECT_EQ(model.distortion, camera.distortion);
  EXPECT_EQ(model.mount_yaw_rad, camera.mount_yaw_rad);
  ASSERT_EQ(read.size(), survey.size());
  ASSERT_TRUE(read.has_odometry());
  ASSERT_TRUE(read.has_ground_truth());
  for (std::size_t i = 0; i < survey.size(); ++i) {
    const FrameInfo& is = read.info(i);
    const FrameInfo& was = survey.info(i);
    EXPECT_EQ(is.time_ns, was.time_ns + how.begin_ns);
    EXPECT_EQ(is.altitude_m, was.altitude_m);
    EXPECT_LT(test::distance(*is.ground_truth, *was.ground_truth), 1e-9);
    EXPECT_EQ(cv::norm(read.image(i), survey.image(i), cv::NORM_INF), 0.0);
    if (i == 0) continue;
    EXPECT_LT(test::distance(is.motion->mean, was.motion->mean), 1e-9);
    EXPECT_LT((is.motion->covariance - was.motion->covariance).norm(),
              1e-9 * was.motion->covariance.norm());
  }
}

TEST_P(BagRoundTrip, HeadingsGoToTheirOwnFolderWithoutHarm) {
  const SimulatedSurvey survey(test::small_survey(), 2);
  write_bag(survey);
  import();
  const std::string rows = read_file(out() / "mav0" / "compass0" / "data.csv");
  const std::string first = std::to_string(1'700'000'000'123'456'789);
  EXPECT_THAT(rows, HasSubstr("\n" + first + ","));
  EXPECT_EQ(ImageFolder(out()).size(), survey.size());
}

TEST_P(BagRoundTrip, ListSaysWhatTopicsAreTakenFor) {
  write_bag(SimulatedSurvey(test::small_survey(), 2));
  const auto lines = bag_topic_list(bag(), {});
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_THAT(lines, Contains(HasSubstr("--images")));
  EXPECT_THAT(lines, Contains(HasSubstr("--reference")));
  EXPECT_THAT(lines, Contains(HasSubstr("geometry_msgs/PointStamped")));
}

}  // namespace
}  // namespace fathom

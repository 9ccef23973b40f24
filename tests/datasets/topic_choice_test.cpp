// What the topics of a bag are taken for by their names.

#include "src/datasets/import/topic_choice.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "support/input_error.hpp"

namespace fathom {
namespace {

using ::testing::HasSubstr;

TopicChoice choice_of(const std::vector<BagTopic>& more) {
  std::vector<BagTopic> topics{{"/cam/image_raw", "sensor_msgs/Image", "", 9},
                               {"/cam/camera_info", "sensor_msgs/CameraInfo", "", 9}};
  topics.insert(topics.end(), more.begin(), more.end());
  return choose_topics(topics, {}, "a.bag");
}

const BagTopic kAltitude{"/altitude", "std_msgs/Float64", "", 9};

TEST(TopicChoice, AnEstimateIsNoGroundTruthForItsLetters) {
  const TopicChoice choice =
      choice_of({kAltitude, {"/gtsam/odometry", "nav_msgs/Odometry", "", 9}});
  EXPECT_EQ(choice.reference, std::nullopt);
  EXPECT_EQ(choice.odometry, 3U);
  for (const char* name : {"/gt/odometry", "/auv_gt_pose", "/groundTruth0", "/ground_truth/odom",
                           "/VICON/rov", "/auv/groundtruth", "/gtpose", "/GTPose", "/GTpose",
                           "/groundtruthpose", "/groundtruths", "/auv/GTOdometry", "/viconpose"}) {
    const TopicChoice truth = choice_of({kAltitude, {name, "nav_msgs/Odometry", "", 9}});
    EXPECT_EQ(truth.reference, 3U) << name;
    EXPECT_EQ(truth.odometry, std::nullopt) << name;
  }
}

TEST(TopicChoice, ARealtimeFactorIsNoAltitude) {
  const BagTopic factor{"/sim/realtime_factor", "std_msgs/Float64", "", 9};
  EXPECT_THAT(test::input_error_of([&] { choice_of({factor}); }),
              HasSubstr("has no altitude that could be guessed"));
  for (const char* name : {"/dvl/altitude", "/altimeter0", "/bottomAltitude", "/dvl_2/data",
                           "/DVLRange", "/altimeters", "/DVLAltitude"}) {
    EXPECT_EQ(choice_of({factor, {name, "std_msgs/Float64", "", 9}}).altitude, 3U) << name;
  }
}

TEST(TopicChoice, DepthAndMasksAreNoPictures) {
  for (const char* name : {"/depthcam/image", "/depthImage", "/masks/image", "/RGBDepth/image"}) {
    EXPECT_EQ(choice_of({kAltitude, {name, "sensor_msgs/Image", "", 9}}).images, 0U) << name;
  }
}

}  // namespace
}  // namespace fathom

// Messages out of order, odometry that starts again, ranges that are none.

#include <cmath>
#include <limits>

#include <gmock/gmock.h>

#include "bag_fixture.hpp"

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::Not;

using test::kBegin;
using test::kSecond;

std::int64_t after_begin(double seconds) {
  return kBegin + std::llround(seconds * 1e9);
}

class BagOrder : public test::BagTest {
 protected:
  /// Pictures of another grey each, altitudes and odometry with these header stamps (seconds); they
  /// are recorded 0.2 s apart.
  void write(const std::vector<double>& stamps) const {
    std::filesystem::remove(bag());
    const auto bag = writer();
    for (std::size_t i = 0; i < stamps.size(); ++i) {
      const test::Stamps at{after_begin(0.2 * static_cast<double>(i) + 0.01),
                            after_begin(stamps[i])};
      write_picture(*bag, at, grey_at(stamps[i]));
      bag->point("/altitude", at, {0, 0, 2 + stamps[i]});
      test::BodyPose body;
      body.position = {stamps[i], 0, 0};
      bag->odometry("/odom", at, body);
    }
  }
  static int grey_at(double stamp) { return static_cast<int>(std::lround(50 + 100 * stamp)); }

  static void write_picture(test::BagWriter& bag, const test::Stamps& at, int grey) {
    test::CameraInformation info;
    info.width = 8;
    info.height = 6;
    info.K = {10, 0, 3.5, 0, 10, 2.5, 0, 0, 1};
    bag.camera_info("/cam/camera_info", at, info);
    test::RawImage image;
    image.width = image.step = 8;
    image.height = 6;
    image.data.assign(48, static_cast<std::uint8_t>(grey));
    bag.image("/cam/image_raw", at, image);
  }
  std::string refusal_of(const std::vector<double>& stamps) const {
    write(stamps);
    return refusal();
  }
  ImportReport import_odometry(const std::vector<double>& x) const {
    std::filesystem::remove(bag());
    {
      const auto bag = writer();
      for (std::size_t i = 0; i < x.size(); ++i) {
        const std::int64_t time_ns = after_begin(0.5 * static_cast<double>(i));
        write_picture(*bag, {time_ns, time_ns}, 90);
        test::BodyPose body;
        body.position = {x[i], 1.0, 0.0};
        bag->odometry("/odom", {time_ns, time_ns}, body);
      }
    }
    BagImportOptions options;
    options.altitude_m = 2.0;
    return import(options);
  }
};
INSTANTIATE_TEST_SUITE_P(Bags, BagOrder, ::testing::Values(1, 2), test::generation);

TEST_P(BagOrder, LateMessagesAreSortedAndSaid) {
  write({0.0, 0.2, 0.6, 0.4, 0.8, 1.2, 0.9, 1.0});
  EXPECT_THAT(import().notes,
              AllOf(Contains("3 messages of /cam/image_raw out of order, by 0.3 s at most: put in "
                             "that of its stamps"),
                    Contains(HasSubstr("3 messages of /altitude out of order")),
                    Contains(HasSubstr("3 messages of /odom out of order"))));
  const ImageFolder folder(out());
  const std::vector<double> sorted{0.0, 0.2, 0.4, 0.6, 0.8, 0.9, 1.0, 1.2};
  ASSERT_EQ(folder.size(), sorted.size());
  for (std::size_t i = 0; i < sorted.size(); ++i) {
    EXPECT_EQ(folder.info(i).time_ns, after_begin(sorted[i])) << i;
    EXPECT_EQ(folder.image(i).at<uchar>(0, 0), grey_at(sorted[i])) << i;
    EXPECT_NEAR(folder.info(i).altitude_m, 2 + sorted[i], 1e-12) << i;
    if (i > 0) {
      EXPECT_NEAR(folder.info(i).motion->mean.x, sorted[i] - sorted[i - 1], 1e-12) << i;
    }
  }
}

TEST_P(BagOrder, AClockThatIsSetBackIsNamed) {
  EXPECT_EQ(refusal_of({0.0, 0.2, 0.4}), "(nothing thrown)");
  EXPECT_THAT(refusal_of({0.0, 0.2, 0.4, 0.2, 0.6}),
              AllOf(HasSubstr("topic /cam/image_raw: time goes back from 1700000000.4"),
                    HasSubstr("at message 4, a time that was there; --clock record")));
  EXPECT_THAT(refusal_of({0.0, 0.5, 1.0, 1.5, 0.4}),
              AllOf(HasSubstr("time goes back"), HasSubstr("at message 5; --clock record")));
  EXPECT_THAT(refusal_of({0.0, 0.5, 1.0, 0.55, 0.65, 0.75}), HasSubstr("at message 6; --clock"));
  // The newest time again is the same message again.
  write({0.0, 0.2, 0.2, 0.4});
  EXPECT_THAT(import().notes, Contains(HasSubstr("3 messages left out: at the time of the one")));
  EXPECT_EQ(ImageFolder(out()).size(), 3U);
}

TEST_P(BagOrder, OdometryThatStartsAgainIsNamedAndItsStepUnknown) {
  const ImportReport report = import_odometry({1, 2, 3, 4, 5, 6, 7, 8, 9, 1, 2, 3});
  EXPECT_THAT(report.notes, Contains(AllOf(HasSubstr("/odom starts again at 1700000004.5"),
                                           HasSubstr("jumps 8 m back to its first pose"))));
  const ImageFolder folder(out());
  for (std::size_t i = 1; i < folder.size(); ++i) {
    const Eigen::Matrix3d& C = folder.info(i).motion->covariance;
    if (i == 9) {
      EXPECT_TRUE(folder.info(i).is_hole);
      EXPECT_NEAR(std::sqrt(C(2, 2)), 1.8, 1e-9);
    } else {
      EXPECT_LT(std::sqrt(C(0, 0)), 0.1) << i;
    }
  }
}

TEST_P(BagOrder, OdometryThatComesBackByItselfDoesNotStartAgain) {
  EXPECT_THAT(import_odometry({0, 1, 2, 3, 2, 1, 0, -1, -2, -1, 0, 1}).notes,
              Not(Contains(HasSubstr("starts again"))));
  // One that stands where it began and goes off.
  EXPECT_THAT(import_odometry({0, 0, 0, 0, 0.5, 1, 0.5, 0, 0, 0}).notes,
              Not(Contains(HasSubstr("starts again"))));
}

TEST_P(BagOrder, RangesThatAreNoneAreLeftOutAndCounted) {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  const std::vector<float> ranges{2.5F, kNaN, 2.5F,  kInfinity, 2.5F, -kInfinity, 2.5F,
                                  0.1F, 2.5F, 30.1F, 2.5F,      0.0F, 2.5F};
  {
    const auto bag = writer();
    for (std::size_t i = 0; i < ranges.size(); ++i) {
      const std::int64_t time_ns = after_begin(0.5 * static_cast<double>(i));
      write_picture(*bag, {time_ns, time_ns}, 90);
      bag->range("/sonar", {time_ns, time_ns}, {ranges[i], 0.2F, 30.0F});
    }
  }
  EXPECT_THAT(import().notes, Contains(HasSubstr("6 altitudes left out: not above zero")));
  const ImageFolder folder(out());
  ASSERT_EQ(folder.size(), ranges.size());
  for (std::size_t i = 0; i < folder.size(); ++i) EXPECT_EQ(folder.info(i).altitude_m, 2.5);
}

}  // namespace
}  // namespace fathom

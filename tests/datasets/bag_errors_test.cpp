// What a bag can have wrong: one line each.

#include <fstream>

#include <gmock/gmock.h>

#include "bag_fixture.hpp"
#include "fathom/core/files.hpp"
#include "fathom/datasets/asl_files.hpp"

namespace fathom {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using ::testing::Not;

using test::kBegin;
using test::kSecond;

class BagErrors : public test::BagTest {
 protected:
  /// Four pictures of 8 x 6 pixels, a camera and altitudes; each to be left out or changed.
  struct Small {
    std::string encoding = "mono8";
    bool has_pictures = true;
    bool has_camera = true;
    bool has_altitude = true;
    std::int64_t altitude_from_ns = kBegin;
    std::int64_t zero_stamp_at = -1;
    std::int64_t back_at = -1;
    std::int64_t larger_at = -1;
    std::string distortion_model = "plumb_bob";
    std::vector<double> D{};
    double fx = 10.0;
  };

  static test::RawImage picture(const Small& small, bool larger) {
    test::RawImage image;
    image.encoding = small.encoding;
    image.height = 6;
    image.width = larger ? 16 : 8;
    image.step = image.width;
    image.data.assign(std::size_t{image.height} * image.step, 50);
    return image;
  }

  void write(const Small& small) const {
    const auto bag = writer();
    for (std::int64_t i = 0; i < 4; ++i) {
      const std::int64_t record_ns = kBegin + i * kSecond;
      std::int64_t header_ns = record_ns - 1000;
      if (i == small.zero_stamp_at) header_ns = 0;
      if (i == small.back_at) header_ns -= 2 * kSecond;
      const test::Stamps stamps{record_ns, header_ns};
      if (small.has_pictures)
        bag->image("/cam/image", stamps, picture(small, i == small.larger_at));
      test::CameraInformation info;
      info.width = 8;
      info.height = 6;
      info.distortion_model = small.distortion_model;
      info.D = small.D;
      info.K = {small.fx, 0, 3.5, 0, small.fx, 2.5, 0, 0, 1};
      if (small.has_camera) bag->camera_info("/cam/camera_info", stamps, info);
      const std::int64_t altitude_ns = small.altitude_from_ns + i * kSecond;
      if (small.has_altitude) bag->point("/altitude", {altitude_ns, altitude_ns - 1000}, {0, 0, 2});
      bag->word("/chatter", stamps, "hello");
    }
  }
  std::string refusal_of(const Small& small, const BagImportOptions& options = {}) const {
    write(small);
    return refusal(options);
  }
};
INSTANTIATE_TEST_SUITE_P(Bags, BagErrors, ::testing::Values(1, 2), test::generation);

TEST_P(BagErrors, TheSmallBagItselfHasNone) {
  EXPECT_EQ(refusal_of({}), "(nothing thrown)");
}

TEST_P(BagErrors, NoPictures) {
  EXPECT_THAT(refusal_of({.has_pictures = false}), HasSubstr("has no pictures"));
}

TEST_P(BagErrors, NoCamera) {
  EXPECT_THAT(refusal_of({.has_camera = false}), HasSubstr("--camera FILE"));
}

TEST_P(BagErrors, NoAltitude) {
  EXPECT_THAT(refusal_of({.has_altitude = false}),
              AllOf(HasSubstr("--altitude TOPIC"), HasSubstr("--altitude-m M")));
}

TEST_P(BagErrors, OneAltitudeForAllIsEnough) {
  BagImportOptions options;
  options.altitude_m = 2.5;
  EXPECT_EQ(refusal_of({.has_altitude = false}, options), "(nothing thrown)");
  EXPECT_EQ(ImageFolder(out()).info(3).altitude_m, 2.5);
}

TEST_P(BagErrors, TopicThatIsNotThereIsSuggested) {
  BagImportOptions options;
  options.images = "/cam/imag";
  EXPECT_THAT(refusal_of({}, options), AllOf(HasSubstr("no topic"), HasSubstr("/cam/image")));
}

TEST_P(BagErrors, TopicOfAnotherType) {
  BagImportOptions options;
  options.altitude = "/chatter";
  EXPECT_THAT(refusal_of({}, options), HasSubstr("is of type std_msgs/String"));
}

TEST_P(BagErrors, UnknownEncoding) {
  EXPECT_THAT(refusal_of({.encoding = "nv21"}),
              AllOf(HasSubstr("topic /cam/image"), HasSubstr("'nv21'")));
}

TEST_P(BagErrors, PictureThatIsNotWhole) {
  EXPECT_THAT(refusal_of({.encoding = "rgb8"}), HasSubstr("is not whole"));
}

TEST_P(BagErrors, PicturesOfDifferentSizes) {
  EXPECT_THAT(refusal_of({.larger_at = 2}), HasSubstr("picture 3 has 16 x 6 pixels"));
}

TEST_P(BagErrors, HeaderWithoutTime) {
  EXPECT_THAT(refusal_of({.zero_stamp_at = 1}), HasSubstr("no time stamp (0); --clock record"));
}

TEST_P(BagErrors, TimeThatGoesBack) {
  EXPECT_THAT(refusal_of({.back_at = 2}),
              AllOf(HasSubstr("/cam/image: time goes back"), HasSubstr("at message 3")));
}

TEST_P(BagErrors, TimesOfRecordingHealBothOfThem) {
  BagImportOptions options;
  options.clock = BagClock::record;
  EXPECT_EQ(refusal_of({.zero_stamp_at = 1, .back_at = 2}, options), "(nothing thrown)");
  EXPECT_EQ(ImageFolder(out()).info(2).time_ns, kBegin + 2 * kSecond);
}

TEST_P(BagErrors, TopicsThatShareNoTime) {
  EXPECT_THAT(refusal_of({.altitude_from_ns = kBegin + 3600 * kSecond}),
              AllOf(HasSubstr("two clocks disagree"), HasSubstr("3600 s later")));
}

TEST_P(BagErrors, ClocksThatDisagree) {
  test::SurveyBag how;
  how.altitude_clock_ns = 5 * kSecond;
  write_bag(SimulatedSurvey(test::small_survey(), 2), how);
  EXPECT_THAT(refusal(), AllOf(HasSubstr("/altitude is 5 s ahead of /camera/image_raw"),
                               HasSubstr("--clock record")));
  BagImportOptions options;
  options.clock = BagClock::record;
  EXPECT_EQ(refusal(options), "(nothing thrown)");
}

TEST_P(BagErrors, StampsInSecondsWhereNanosecondsBelong) {
  test::SurveyBag how;
  how.stamp_unit = kSecond;
  how.begin_ns = kBegin;
  write_bag(SimulatedSurvey(test::small_survey(), 2), how);
  BagImportOptions options;
  options.odometry = "none";
  EXPECT_THAT(refusal(options), HasSubstr("are they in another unit"));
}

TEST_P(BagErrors, CutShort) {
  write({});
  const std::string whole = read_file(bag());
  for (const double share : {0.0001, 0.3, 0.7, 0.999}) {
    const auto size = static_cast<std::size_t>(share * static_cast<double>(whole.size()));
    std::ofstream(bag(), std::ios::binary) << whole.substr(0, size);
    const std::string said = test::input_error_of([&] { import_kind(bag()); });
    const std::string why = said == "(nothing thrown)" ? refusal() : said;
    EXPECT_THAT(why, Not(HasSubstr("nothing thrown"))) << share;
    EXPECT_THAT(why, HasSubstr(bag().string())) << share;
  }
}

TEST_P(BagErrors, RecordedInAnotherAge) {
  if (GetParam() == 1) return;  // whose times have an end before the limit
  EXPECT_THAT(refusal_of({.altitude_from_ns = kMostTimeNs + 1}),
              HasSubstr("topic /altitude: a message was recorded at 4500000000000000001 ns; the "
                        "limit is 4500000000000000000 ns"));
}

TEST_P(BagErrors, ChunkThatWouldFillMemory) {
  if (GetParam() == 2) return;
  write({});
  std::string bytes = read_file(bag());
  const std::string size = "size=";
  const std::size_t at = bytes.find(size, bytes.find("compression="));
  ASSERT_NE(at, std::string::npos);
  std::ofstream(bag(), std::ios::binary) << bytes.replace(at + size.size(), 4, "\xFF\xFF\xFF\xFF");
  EXPECT_THAT(refusal(), HasSubstr("has a chunk of 4294967295 bytes; the limit is 128000000"));
}

}  // namespace
}  // namespace fathom

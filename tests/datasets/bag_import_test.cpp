// A survey written as a bag by what Fathom does not read with comes back as it was.

#include <gmock/gmock.h>

#include "bag_fixture.hpp"
#include "fathom/core/files.hpp"
#include "support/planar.hpp"
#include "support/requirements.hpp"

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

TEST_P(BagRoundTrip, HeadingsGoToTheirOwnFolder) {
  const SimulatedSurvey survey(test::small_survey(), 2);
  write_bag(survey);
  import();
  const std::string rows = read_file(out() / "mav0" / "compass0" / "data.csv");
  const std::string first = std::to_string(1'700'000'000'123'456'789);
  EXPECT_THAT(rows, HasSubstr("\n" + first + ","));
  const ImageFolder folder(out());
  EXPECT_EQ(folder.size(), survey.size());
  const AbsoluteReadings readings = in_world(folder.sensors(), std::nullopt);
  ASSERT_GT(readings.headings.size(), 1U);
  for (const MeasuredHeading& reading : readings.headings) {
    EXPECT_NEAR(reading.sigma_rad, 0.02, 1e-12);
  }
}

SimulatedSurveyOptions rolling_survey() {
  SimulatedSurveyOptions options = test::small_survey();
  options.attitude.both_sigma_rad = 0.05;
  options.attitude.measured_sigma_rad = 0.003;
  return options;
}

TEST_P(BagRoundTrip, RollAndPitchOfAnImuComeBack) {
  const SimulatedSurvey survey(rolling_survey(), 6);
  write_bag(survey);
  EXPECT_THAT(import().facts, Contains(HasSubstr("from /imu: roll ")));
  const ImageFolder read(out());
  ASSERT_EQ(read.size(), survey.size());
  for (std::size_t i = 0; i < survey.size(); ++i) {
    const MeasuredTilt& is = read.info(i).tilt.value();
    const MeasuredTilt& was = survey.info(i).tilt.value();
    EXPECT_NEAR(is.tilt.roll_rad, was.tilt.roll_rad, 1e-12);
    EXPECT_NEAR(is.tilt.pitch_rad, was.tilt.pitch_rad, 1e-12);
    EXPECT_NEAR(is.sigma_rad, was.sigma_rad, 1e-12);
  }
}

TEST_P(BagRoundTrip, TheSigmaOfAnAttitudeIsAskedForOrGuessed) {
  write_bag(SimulatedSurvey(rolling_survey(), 6), {.imu_has_variance = false});
  EXPECT_THAT(import().notes, Contains(HasSubstr("without variance in the bag: taken for good to "
                                                 "0.01 rad")));
  EXPECT_EQ(ImageFolder(out()).info(3).tilt->sigma_rad, 0.01);
  std::filesystem::remove_all(out());
  BagImportOptions options;
  options.attitude_sigma_rad = 0.002;
  import(options);
  EXPECT_EQ(ImageFolder(out()).info(3).tilt->sigma_rad, 0.002);
}

TEST_P(BagRoundTrip, NoAttitudeOfAnImuOnItsSideOrOneThatIsNotAskedFor) {
  const SimulatedSurvey survey(rolling_survey(), 6);
  write_bag(survey, {.imu_roll_rad = 1.5707});
  EXPECT_THAT(import().notes, Contains(HasSubstr("its axes are not the body's")));
  EXPECT_FALSE(ImageFolder(out()).has_attitude());
  std::filesystem::remove_all(out());
  for (const char* flag : {"attitude", "heading"}) {
    BagImportOptions options;
    (std::string(flag) == "attitude" ? options.attitude : options.heading) = "none";
    import(options);
    EXPECT_FALSE(std::filesystem::exists(out() / "mav0" / "attitude0")) << flag;
    EXPECT_EQ(std::filesystem::exists(out() / "mav0" / "compass0"), std::string(flag) != "heading");
    std::filesystem::remove_all(out());
  }
}

TEST_P(BagRoundTrip, AnAttitudeThatBeginsLateCostsPicturesIfItIsAskedFor) {
  const SimulatedSurvey survey(rolling_survey(), 6);
  write_bag(survey, {.imu_from = 2});
  EXPECT_THAT(import().notes, Contains(HasSubstr("2 pictures lie outside of its readings; "
                                                 "--attitude /imu leaves them out")));
  EXPECT_FALSE(ImageFolder(out()).has_attitude());
  EXPECT_EQ(ImageFolder(out()).size(), survey.size());
  std::filesystem::remove_all(out());
  BagImportOptions options;
  options.attitude = "/imu";
  import(options);
  EXPECT_TRUE(ImageFolder(out()).has_attitude());
  EXPECT_EQ(ImageFolder(out()).size(), survey.size() - 2);
}

TEST_P(BagRoundTrip, ListSaysWhatTopicsAreTakenFor) {
  write_bag(SimulatedSurvey(test::small_survey(), 2));
  const auto lines = bag_topic_list(bag(), {});
  ASSERT_EQ(lines.size(), 7U);
  EXPECT_THAT(lines, Contains(HasSubstr("--images")));
  EXPECT_THAT(lines, Contains(HasSubstr("--reference")));
  EXPECT_THAT(lines, Contains(HasSubstr("--heading --attitude")));
  EXPECT_THAT(lines, Contains(HasSubstr("geometry_msgs/PointStamped")));
}

// What is stored in other ways than the plain one: the same folder comes of it.
class BagStorage : public ::testing::Test {
 protected:
  std::string odometry_of(const std::filesystem::path& bag) const {
    import_bag(bag, {}, folder_ / "out");
    return read_file(folder_ / "out" / "mav0" / "odometry0" / "data.csv");
  }

  SimulatedSurvey survey_{test::small_survey(), 2};
  test::TemporaryFolder folder_;
};

TEST_F(BagStorage, CompressedChunksOfRos1) {
  using test::BagCompression;
  if (test::ros1_bag_writer(folder_ / "probe.bag") == nullptr) {
    GTEST_SKIP() << test::kNoRos1Writer;
  }
  std::vector<std::string> rows;
  for (const auto compression : {BagCompression::none, BagCompression::bz2, BagCompression::lz4}) {
    const auto bag = folder_ / (std::to_string(rows.size()) + ".bag");
    test::write_survey_bag(survey_, *test::ros1_bag_writer(bag, compression));
    rows.push_back(odometry_of(bag));
  }
  EXPECT_LT(std::filesystem::file_size(folder_ / "1.bag"),
            std::filesystem::file_size(folder_ / "0.bag"));
  EXPECT_EQ(rows[1], rows[0]);
  EXPECT_EQ(rows[2], rows[0]);
}

TEST_F(BagStorage, BigEndianMessagesOfRos2) {
  test::write_survey_bag(survey_, *test::ros2_bag_writer(folder_ / "little.db3"));
  test::write_survey_bag(survey_, *test::ros2_bag_writer(folder_ / "big.db3", true));
  EXPECT_EQ(odometry_of(folder_ / "big.db3"), odometry_of(folder_ / "little.db3"));
}

// The recorder begins a new file when one is full.
TEST_F(BagStorage, FolderOfSeveralFilesOfRos2) {
  const auto bag = folder_ / "bag";
  std::filesystem::create_directories(bag);
  test::SurveyBag later;
  later.begin_ns += 1'000'000'000'000;
  test::write_survey_bag(survey_, *test::ros2_bag_writer(bag / "b_0.db3"));
  test::write_survey_bag(survey_, *test::ros2_bag_writer(bag / "a_1.db3"), later);
  write_file(bag / "metadata.yaml",
             "rosbag2_bagfile_information:\n  version: 5\n  storage_identifier: sqlite3\n"
             "  compression_format: \"\"\n  relative_file_paths: [b_0.db3, a_1.db3]\n");
  BagImportOptions options;
  options.odometry_sigma_m = 0.1;
  import_bag(bag, options, folder_ / "out");
  EXPECT_EQ(ImageFolder(folder_ / "out").size(), 2 * survey_.size());
  std::filesystem::remove(bag / "a_1.db3");
  EXPECT_THAT(test::input_error_of([&] { import_bag(bag, options, folder_ / "out"); }),
              HasSubstr("names 'a_1.db3', which is not in the folder"));
}

// A recorder that crashed leaves no metadata: the tenth file is not the second.
TEST_F(BagStorage, FilesWithoutMetadataAreInOrderOfTheirNumbers) {
  const auto bag = folder_ / "bag";
  std::filesystem::create_directories(bag);
  test::SurveyBag later;
  later.begin_ns += 1'000'000'000'000;
  test::write_survey_bag(survey_, *test::ros2_bag_writer(bag / "bag_9.db3"));
  test::write_survey_bag(survey_, *test::ros2_bag_writer(bag / "bag_10.db3"), later);
  BagImportOptions options;
  options.odometry_sigma_m = 0.1;
  import_bag(bag, options, folder_ / "out");
  EXPECT_EQ(ImageFolder(folder_ / "out").size(), 2 * survey_.size());
}

}  // namespace
}  // namespace fathom

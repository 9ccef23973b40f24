// A survey with a part of the vehicle in view, from its files to what a run says of it.

#include <filesystem>
#include <fstream>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>

#include "configuration/configured.hpp"
#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/picture_file.hpp"
#include "fathom/estimators/builtin.hpp"
#include "fathom/harness/run_folder.hpp"
#include "fathom/harness/survey.hpp"
#include "harness/small_config.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::configured;
using test::kSmallSurvey;
using ::testing::HasSubstr;
using ::testing::SizeIs;

constexpr int kSkidRows = 20;  // of 120

// The small survey as recorded, with a skid over the lowest sixth of every picture.
class MaskedSurvey : public ::testing::Test {
 protected:
  MaskedSurvey() {
    const Survey simulated(configured(kSmallSurvey));
    write_image_folder(simulated.frames(), root_.path());
    cv::RNG random(5);
    cv::Mat small(kSkidRows / 4, 40, CV_8U);
    random.fill(small, cv::RNG::UNIFORM, 30, 220);
    cv::resize(small, skid_, {160, kSkidRows}, 0, 0, cv::INTER_NEAREST);
    const ImageFolder folder(root_.path());
    for (std::size_t i = 0; i < folder.size(); ++i) {
      cv::Mat picture = folder.image(i);
      skid_.copyTo(picture.rowRange(120 - kSkidRows, 120));
      write_png(folder.picture(i), picture);
    }
  }

  Configuration configuration(const std::string& more = "") const {
    return configured("dataset: {type: image_folder, path: '" + root_.path().string() +
                      "'}\nfront_end.keyframes.separation_frames: 3\n" + more);
  }

  // How far the registrations are off, at most.
  static double worst_m(const Recording& recording) {
    double worst = 0.0;
    for (std::size_t k = 1; k < recording.log.size(); ++k) {
      for (const RelativePose& z : recording.log.arrival(k).registrations) {
        const Pose truth =
            between((*recording.ground_truth)[z.from], (*recording.ground_truth)[z.to]);
        worst = std::max(worst, (z.motion.position() - truth.position()).norm());
      }
    }
    return worst;
  }

  test::TemporaryFolder root_;
  cv::Mat skid_;
};

TEST_F(MaskedSurvey, IsRegisteredByItsFloorAndSaysSo) {
  const Recording recording = record(configuration(), builtin_estimators());
  ASSERT_EQ(recording.mask.size(), cv::Size(160, 120));
  EXPECT_EQ(cv::countNonZero(recording.mask.rowRange(104, 120)), 0);
  ASSERT_THAT(recording.remarks, SizeIs(1));
  EXPECT_THAT(recording.remarks.front(), HasSubstr("the lowest"));
  EXPECT_GT(recording.log.registration_count(), 20u);
  EXPECT_LT(worst_m(recording), 0.05);

  const test::TemporaryFolder out;
  write_recording(out.path(), recording);
  const cv::Mat written = read_grey_picture(out / "mask.png");
  EXPECT_EQ(cv::norm(written, recording.mask, cv::NORM_INF), 0.0);
}

TEST_F(MaskedSurvey, OffLeavesItAsItIs) {
  const Recording recording = record(configuration("front_end.mask: off\n"), builtin_estimators());
  EXPECT_TRUE(recording.mask.empty());
  EXPECT_THAT(recording.remarks, SizeIs(0));
  const test::TemporaryFolder out;
  write_recording(out.path(), recording);
  EXPECT_FALSE(std::filesystem::exists(out / "mask.png"));
}

TEST_F(MaskedSurvey, AMaskOfItsOwnIsTaken) {
  cv::Mat mask(120, 160, CV_8U, cv::Scalar(255));
  mask.rowRange(90, 120).setTo(0);
  write_png(root_ / "mav0" / "cam0" / "mask.png", mask);
  const Recording recording = record(configuration(), builtin_estimators());
  EXPECT_EQ(cv::norm(recording.mask, mask, cv::NORM_INF), 0.0);
  EXPECT_THAT(recording.remarks.front(), HasSubstr("as the data set says"));
  EXPECT_LT(worst_m(recording), 0.05);
}

}  // namespace
}  // namespace fathom

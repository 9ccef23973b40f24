// Which images of a COLMAP model are which pictures: by their names.

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/datasets/import.hpp"
#include "fathom/geometry/trajectory.hpp"
#include "support/pictures.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using ::testing::Contains;
using ::testing::HasSubstr;

class ColmapOrder : public testing::Test {
 protected:
  void SetUp() override { std::filesystem::create_directories(folder_ / "model"); }

  // A camera that looks down from 2 m, so far ahead.
  static std::string image(double ahead_m, const std::string& name) {
    return "1 0 1 0 0 0 " + exact(ahead_m) + " 2 1 " + name + "\n\n";
  }
  std::vector<StampedPose> imported(const std::string& images,
                                    const PoseImportOptions& options = {}) const {
    write_file(folder_ / "model" / "images.txt", images);
    import_colmap(folder_ / "model", options, folder_.path());
    return read_tum(folder_ / "reference.tum");
  }

  test::TemporaryFolder folder_;
};

// As the pictures of a plain folder are: the tenth is not the second.
TEST_F(ColmapOrder, IsThatOfTheNumbersInTheNames) {
  std::string images;
  for (int i = 1; i <= 12; ++i) images += image(0.5 * i, "img" + std::to_string(i) + ".png");
  const std::vector<StampedPose> poses = imported(images);
  ASSERT_EQ(poses.size(), 12U);
  for (std::size_t i = 0; i < poses.size(); ++i) {
    EXPECT_NEAR(poses[i].pose.x, 0.5 * static_cast<double>(i), 1e-9);
  }
}

// The second of the three was not registered.
TEST_F(ColmapOrder, TimesAreThoseOfPlainPictures) {
  std::filesystem::create_directories(folder_ / "photos");
  for (const char* name : {"img9.png", "img10.png", "img11.png"}) {
    test::write_picture(folder_ / "photos" / name, cv::Mat(6, 8, CV_8UC1, cv::Scalar(90)));
  }
  PoseImportOptions options;
  options.survey = folder_ / "photos";
  const std::vector<StampedPose> poses =
      imported(image(0.0, "img9.png") + image(2.0, "img11.png"), options);
  ASSERT_EQ(poses.size(), 2U);
  EXPECT_EQ(poses[1].time_ns, 2'000'000'000);
  EXPECT_NEAR(poses[1].pose.x, 2.0, 1e-9);
  const ImportReport report = import_colmap(folder_ / "model", options, folder_ / "again");
  EXPECT_THAT(report.notes, Contains(HasSubstr("the reference is for dataset.interval_s 1")));
}

}  // namespace
}  // namespace fathom

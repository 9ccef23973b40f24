// Holes in odometry0 of an image folder.

#include "fathom/datasets/odometry_gaps.hpp"

#include <string>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/datasets/image_folder.hpp"
#include "fathom/datasets/sensor_summary.hpp"
#include "folder_fixture.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::FolderFixture;
using test::input_error_of;
using ::testing::Contains;
using ::testing::HasSubstr;

// Odometry at 100 ns stops from 600 to 1400 ns, and ends before the last picture.
TEST(OdometryGaps, BecomeHolesWithADeclaredMotion) {
  FolderFixture fixture;
  std::string rows;
  for (const int t : {0, 100, 200, 300, 400, 500, 600, 1400, 1500, 1600, 1700, 1800}) {
    rows += std::to_string(t) + "," + std::to_string(t) + ",0,0,0.01,0.01,0.01\n";
  }
  fixture.files["odometry0/data.csv"] = rows;
  const auto root = fixture.write();
  OdometryGaps gaps;
  gaps.least_intervals = 5;
  gaps.declared.sigma_m = 4.0;
  gaps.declared.sigma_rad = 0.5;
  const ImageFolder folder(root, gaps);
  // To 1000 ns: six steps of 100 m, and half of the hole.
  EXPECT_TRUE(folder.info(1).is_hole);
  EXPECT_NEAR(folder.info(1).motion->mean.x, 600.0, 1e-9);
  EXPECT_NEAR(folder.info(1).motion->covariance(0, 0), 0.06 + 8.0, 1e-9);
  EXPECT_TRUE(folder.info(2).is_hole);
  EXPECT_NEAR(folder.info(2).motion->mean.x, 400.0, 1e-9);
  EXPECT_NEAR(folder.info(2).motion->covariance(0, 0), 8.0 + 0.04 + 16.0, 1e-9);
  FolderSummary summary;
  sum_up_holes(folder, nullptr, summary);
  EXPECT_THAT(summary.facts, Contains(HasSubstr("odometry: 1 hole")));
  EXPECT_THAT(summary.warnings, Contains(HasSubstr("dataset.gap_intervals: 5")));
  // Without the option the end is refused, with the remedy.
  EXPECT_THAT(input_error_of([&] { const ImageFolder refused(root); }),
              HasSubstr("or dataset.gap_intervals, which makes holes"));
}

TEST(OdometryGaps, NoneWhereOdometryGoesOn) {
  OdometryGaps gaps;
  gaps.least_intervals = 1.5;
  const FolderFixture fixture;
  const auto root = fixture.write();
  const ImageFolder plain(root);
  const ImageFolder asked(root, gaps);
  for (std::size_t i = 1; i < 3; ++i) {
    EXPECT_FALSE(asked.info(i).is_hole);
    EXPECT_EQ(asked.info(i).motion->mean, plain.info(i).motion->mean);
    EXPECT_EQ(asked.info(i).motion->covariance, plain.info(i).motion->covariance);
  }
}

}  // namespace
}  // namespace fathom

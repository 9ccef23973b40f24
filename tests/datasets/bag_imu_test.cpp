// Orientations of an Imu that are none.

#include <cmath>

#include <gmock/gmock.h>

#include "bag_fixture.hpp"
#include "fathom/core/files.hpp"

namespace fathom {
namespace {

using test::kBegin;
using test::kSecond;
using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;

class BagImu : public test::BagTest {
 protected:
  using Rotation = std::array<double, 4>;

  ImportReport import_with(const std::vector<Rotation>& rotations, double variance) const {
    {
      const auto bag = writer();
      test::CameraInformation info;
      info.width = 4;
      info.height = 2;
      info.K = {10, 0, 1.5, 0, 12, 0.5, 0, 0, 1};
      test::RawImage raw{2, 4, "mono8", false, 4, std::vector<std::uint8_t>(8, 90)};
      for (std::size_t i = 0; i < rotations.size(); ++i) {
        const std::int64_t time_ns = kBegin + std::int64_t(i) * kSecond;
        bag->camera_info("/cam/camera_info", {time_ns, time_ns}, info);
        bag->image("/cam/image_raw", {time_ns, time_ns}, raw);
        bag->imu("/imu/data_raw", {time_ns, time_ns}, rotations[i],
                 {variance, 0, 0, 0, variance, 0, 0, 0, variance});
      }
    }
    BagImportOptions options;
    options.altitude_m = 2.0;
    return import(options);
  }
  bool has(const char* sensor) const {
    return std::filesystem::exists(out() / "mav0" / sensor / "data.csv");
  }
};
INSTANTIATE_TEST_SUITE_P(Bags, BagImu, ::testing::Values(1, 2), test::generation);

// ROS 2 gives a message the identity, whose covariance is zero.
TEST_P(BagImu, ADefaultOrientationIsNoCompassAndNoLevel) {
  const Rotation identity{0, 0, 0, 1};
  const ImportReport report = import_with({identity, identity, identity}, 0.0);
  EXPECT_FALSE(has("compass0"));
  EXPECT_FALSE(has("attitude0"));
  EXPECT_THAT(report.notes,
              AllOf(Contains(HasSubstr("no heading: /imu/data_raw says that it has no orientation, "
                                       "or leaves it at its default in all messages")),
                    Contains(HasSubstr("no attitude: /imu/data_raw says"))));
}

TEST_P(BagImu, AnOrientationThatChangesOrHasAVarianceIsOne) {
  const Rotation identity{0, 0, 0, 1};
  import_with({identity, {0, 0, std::sin(0.1), std::cos(0.1)}, identity}, 0.0);
  EXPECT_TRUE(has("compass0"));
  std::filesystem::remove_all(out());
  std::filesystem::remove(bag());
  import_with({identity, identity, identity}, 1e-4);
  EXPECT_TRUE(has("compass0"));
  EXPECT_TRUE(has("attitude0"));
}

// 1e6 is what some drivers write for it.
TEST_P(BagImu, AnOrientationThatMayBeAnyIsNoCompassAndNoLevel) {
  for (const double variance : {1e6, -2.0, std::nan("")}) {
    const ImportReport report = import_with({{0, 0, 0.1, 1}, {0, 0, 0, 1}}, variance);
    EXPECT_FALSE(has("compass0")) << variance;
    EXPECT_THAT(report.notes, Contains(HasSubstr("2 headings left out: by a variance that is not "
                                                 "within 0 to pi^2 /imu/data_raw says")));
    EXPECT_FALSE(has("attitude0")) << variance;
    EXPECT_THAT(report.notes, Contains(HasSubstr("2 attitudes left out: by a variance that is not "
                                                 "within 0 to 0.25 /imu/data_raw says")));
    std::filesystem::remove_all(out());
    std::filesystem::remove(bag());
  }
  const ImportReport report = import_with({{0, 0, 0.1, 1}, {0, 0, 0, 1}}, 0.0);
  EXPECT_THAT(read_text(out() / "mav0" / "compass0" / "data.csv"), HasSubstr(",0.05000"));
  EXPECT_THAT(report.notes, Contains(HasSubstr("2 headings without variance in the bag: taken for "
                                               "good to 0.05 rad")));
}

}  // namespace
}  // namespace fathom

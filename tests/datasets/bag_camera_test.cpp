// What CameraInfo says of the camera: models of distortion, messages without a calibration,
// changes.

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

class BagCamera : public test::BagTest {
 protected:
  static test::CameraInformation information() {
    test::CameraInformation info;
    info.width = 64;
    info.height = 48;
    info.K = {60, 0, 31.5, 0, 60, 23.5, 0, 0, 1};
    info.P = {60, 0, 31.5, 0, 0, 60, 23.5, 0, 0, 0, 1, 0};
    return info;
  }
  /// A bag with a picture for each, a second apart.
  void write(const std::vector<test::CameraInformation>& infos,
             const std::string& images = "/cam/image_raw") const {
    std::filesystem::remove(bag());
    test::RawImage image;
    image.width = image.step = 64;
    image.height = 48;
    image.data.assign(std::size_t{64} * 48, 50);
    const auto bag = writer();
    for (std::size_t i = 0; i < infos.size(); ++i) {
      const std::int64_t time_ns = kBegin + static_cast<std::int64_t>(i) * kSecond;
      bag->camera_info("/cam/camera_info", {time_ns, time_ns}, infos[i]);
      bag->image(images, {time_ns, time_ns}, image);
    }
  }
  static BagImportOptions options() {
    BagImportOptions options;
    options.altitude_m = 2.0;
    return options;
  }
  std::string refusal_of(const std::vector<test::CameraInformation>& infos,
                         const std::string& images = "/cam/image_raw") const {
    write(infos, images);
    return refusal(options());
  }
  std::string refusal_of(const std::string& model, const std::vector<double>& D) const {
    test::CameraInformation info = information();
    info.distortion_model = model;
    info.D = D;
    return refusal_of({info});
  }
  CameraModel camera_of(const std::string& model, const std::vector<double>& D) const {
    EXPECT_EQ(refusal_of(model, D), "(nothing thrown)");
    return ImageFolder(out()).camera().model();
  }
};
INSTANTIATE_TEST_SUITE_P(Bags, BagCamera, ::testing::Values(1, 2), test::generation);

TEST_P(BagCamera, EachModelOfDistortionIsRead) {
  struct Case {
    const char* name;
    std::vector<double> D;
    DistortionModel model;
  };
  constexpr auto kRadial = DistortionModel::radial_tangential;
  constexpr auto kFisheye = DistortionModel::equidistant;
  constexpr auto kRational = DistortionModel::rational_polynomial;
  for (const Case& c : std::vector<Case>{
           {"plumb_bob", {0.1, 0.02, 0.003, 0.004, 0.005}, kRadial},
           {"plumb_bob", {0.1, 0.02, 0.003, 0.004}, kRadial},
           {"plumb_bob", {}, kRadial},
           {"", {0, 0, 0, 0, 0}, kRadial},
           {"rational_polynomial", {0.1, 0.02, 0, 0, 0.005, 0, 0, 0}, kRadial},
           {"rational_polynomial", {0.1, 0.02, 0.003, 0.004, 0.005, 0.06, 0.007, 0.008}, kRational},
           {"rational_polynomial",
            {0.1, 0.02, 0.003, 0.004, 0.005, 0.06, 0.007, 0.008, 0, 0, 0, 0},
            kRational},
           {"equidistant", {0.1, 0.02, 0.003, 0.004}, kFisheye},
           {"equidistant", {0, 0, 0, 0}, kFisheye},
           {"fisheye", {0.1, 0.02, 0.003, 0.004}, kFisheye}}) {
    const CameraModel model = camera_of(c.name, c.D);
    std::array<double, 8> expected{};
    std::copy_n(c.D.begin(), std::min(c.D.size(), expected.size()), expected.begin());
    EXPECT_EQ(model.distortion_model, c.model) << c.name;
    EXPECT_EQ(model.distortion, expected) << c.name;
  }
}

TEST_P(BagCamera, OtherModelsAreNamed) {
  EXPECT_THAT(refusal_of("thin_prism", {0.1}),
              AllOf(HasSubstr("topic /cam/camera_info: its distortion model 'thin_prism'"),
                    HasSubstr("plumb_bob, rational_polynomial, equidistant or fisheye")));
  EXPECT_THAT(refusal_of("plumb_bob", {0, 0, 0, 0, 0, 0.1, 0, 0}),
              HasSubstr("'plumb_bob' has 8 numbers; expected [k1, k2, p1, p2, k3]"));
  EXPECT_THAT(refusal_of("rational_polynomial", {0, 0, 0, 0, 0, 0.1, 0, 0, 0.2, 0, 0, 0}),
              HasSubstr("has 12 numbers; expected [k1, k2, p1, p2, k3, k4, k5, k6]"));
  EXPECT_THAT(refusal_of("fisheye", {}), HasSubstr("has 0 numbers; expected [k1, k2, k3, k4]"));
  EXPECT_THAT(refusal_of("equidistant", {-2, 0, 0, 0}), HasSubstr("folds the picture over"));
}

TEST_P(BagCamera, WithoutCalibrationOrSizeItIsNamed) {
  test::CameraInformation zero = information();
  zero.K = {};
  EXPECT_THAT(refusal_of({zero, zero}), AllOf(HasSubstr("topic /cam/camera_info"),
                                              HasSubstr("focal lengths in K are not above zero")));
  test::CameraInformation no_size = information();
  no_size.width = no_size.height = 0;
  EXPECT_THAT(refusal_of({no_size}), HasSubstr("/cam/camera_info: is of 0 x 0 pixels; --camera"));
}

TEST_P(BagCamera, OneThatComesLateIsTaken) {
  test::CameraInformation zero = information();
  zero.K = {};
  test::CameraInformation no_size = information();
  no_size.width = 0;
  write({zero, no_size, information(), zero});
  EXPECT_THAT(import(options()).notes, Contains(HasSubstr("3 CameraInfos left out: without")));
  EXPECT_EQ(ImageFolder(out()).camera().model().fx, 60.0);
  write({information(), information()});
  EXPECT_THAT(import(options()).notes, Not(Contains(HasSubstr("left out"))));
}

TEST_P(BagCamera, OneThatChangesIsNamedWithItsTime) {
  const auto with = [](auto change) {
    test::CameraInformation info = information();
    change(info);
    return std::vector<test::CameraInformation>{information(), information(), info};
  };
  EXPECT_THAT(refusal_of(with([](auto& info) { info.K[0] = 61; })),
              AllOf(HasSubstr("topic /cam/camera_info: the camera changes at 1700000002"),
                    HasSubstr(" s: K; "), HasSubstr("--camera FILE")));
  EXPECT_THAT(refusal_of(with([](auto& info) {
                info.width = 32;
                info.D = {0.1, 0, 0, 0, 0};
                info.binning = 2;
                info.x_offset = 2;
                info.distortion_model = "fisheye";
              })),
              HasSubstr(" s: size, binning, region of interest, D, distortion_model; "));
  const auto other_projection = with([](auto& info) { info.P[0] = 61; });
  EXPECT_THAT(refusal_of(other_projection, "/cam/image_rect"), HasSubstr(" s: P; "));
  // What the camera is not made of may change.
  EXPECT_EQ(refusal_of(other_projection), "(nothing thrown)");
  EXPECT_EQ(refusal_of(with([](auto& info) { info.K[0] = 61; }), "/cam/image_rect"),
            "(nothing thrown)");
  EXPECT_EQ(refusal_of(with([](auto& info) { info.binning = 1; })), "(nothing thrown)");
}

TEST_P(BagCamera, OfAnotherSizeThanThePicturesItIsNamed) {
  test::CameraInformation wider = information();
  wider.width = 65;
  EXPECT_THAT(refusal_of({wider}), HasSubstr("is of a width of 65 pixels, the pictures have 64"));
  // A picture binned by two may have lost an odd row.
  test::CameraInformation binned = information();
  binned.width = 128;
  binned.height = 99;
  binned.binning = 2;
  EXPECT_EQ(refusal_of({binned}), "(nothing thrown)");
}

}  // namespace
}  // namespace fathom

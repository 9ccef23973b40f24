// Marks of known places on Earth, read back by GDAL.

#include "fathom/report/geo_tiff.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/report/picture.hpp"
#include "fathom/report/world_file.hpp"
#include "support/gdal.hpp"
#include "support/input_error.hpp"
#include "support/pictures.hpp"
#include "support/requirements.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

using test::gdal_info;
using test::gdal_place;
using test::gdal_projected;

constexpr double kMarkRadius_m = 0.6;

/// A grey floor with a bright disc, seen from 20 m by a camera that is mounted off the middle.
class MarkedFloor : public FrameSource {
 public:
  MarkedFloor(const Eigen::Vector2d& mark, std::vector<PlacedPicture> truth)
      : mark_(mark), truth_(std::move(truth)) {}

  const Camera& camera() const override { return camera_; }
  std::size_t size() const override { return truth_.size(); }
  const FrameInfo& info(std::size_t) const override { return info_; }
  cv::Mat image(std::size_t i) const override {
    cv::Mat picture(camera_.model().height, camera_.model().width, CV_8U);
    for (int v = 0; v < picture.rows; ++v) {
      for (int u = 0; u < picture.cols; ++u) {
        const Eigen::Vector2d floor =
            transform(truth_[i].pose, camera_.floor_point(Eigen::Vector2d(u, v), truth_[i].stance));
        picture.at<unsigned char>(v, u) = (floor - mark_).norm() < kMarkRadius_m ? 230 : 100;
      }
    }
    return picture;
  }
  std::uint64_t picture_id(std::size_t i) const override { return i; }
  bool has_odometry() const override { return false; }
  bool has_ground_truth() const override { return false; }

 private:
  static CameraModel model() {
    CameraModel model;
    model.width = 160;
    model.height = 120;
    model.fx = model.fy = 200;
    model.cx = 79.5;
    model.cy = 59.5;
    model.mount_x_m = 3.0;
    model.mount_y_m = -2.0;
    model.mount_yaw_rad = 0.6;
    return model;
  }

  Camera camera_{model()};
  Eigen::Vector2d mark_;
  std::vector<PlacedPicture> truth_;
  FrameInfo info_;
};

// The middle of what is bright, in pixels.
Eigen::Vector2d middle_of_mark(const cv::Mat& picture) {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  int count = 0;
  for (int v = 0; v < picture.rows; ++v) {
    for (int u = 0; u < picture.cols; ++u) {
      const unsigned char grey = picture.at<unsigned char>(v, u);
      if (grey < 165 || grey == kUnseen) continue;
      sum += Eigen::Vector2d(u, v);
      ++count;
    }
  }
  EXPECT_GT(count, 30);
  return sum / count;
}

class GeoTiffTest : public ::testing::Test {
 protected:
  void SetUp() override {
    FATHOM_REQUIRE_FEATURE("geotiff");
    if (!test::has_gdal()) GTEST_SKIP() << test::kNoGdal;
  }
  std::filesystem::path path(const std::string& name) const { return folder_ / name; }

  // As GDAL reads it: all of it, or one of its overviews.
  cv::Mat read_by_gdal(const std::string& name, const std::string& overview = "NONE") const {
    test::printed_by("gdal_translate -q -ovr " + overview + " -of PNG " + path(name).string() +
                     " " + path("read.png").string());
    return test::read_picture(path("read.png"), cv::IMREAD_UNCHANGED);
  }

 private:
  test::TemporaryFolder folder_;
};

const std::vector<EarthOrigin> kOrigins{
    {39.5, 2.5, 0.0},       {39.5, 2.5, 90.0},    {39.5, 2.5, 213.0},
    {-33.86, 151.2, 213.0}, {0.01, 5.9999, 45.0}, {-10.0, 179.99999, 90.0},
    {65.0, -180.0, 300.0},  {85.5, 30.0, 213.0},  {-88.0, -120.0, 10.0}};

TEST_F(GeoTiffTest, AMarkLiesWhereItShouldToAPixel) {
  constexpr double kPixel_m = 0.1;
  const Eigen::Vector2d mark(402.0, -297.0);
  const std::vector<PlacedPicture> truth{{0, 20.0, {0, 0, 0}}, {1, 20.0, {400, -300, 2.0}}};
  const MarkedFloor floor(mark, truth);
  for (const EarthOrigin& origin : kOrigins) {
    SCOPED_TRACE(testing::Message() << origin.latitude_deg << ", " << origin.longitude_deg << ", "
                                    << origin.heading_deg);
    const EarthFrame earth(origin);
    const auto placed = placed_on_grid(earth, floor.camera(), truth);
    const MosaicPlan plan = plan_mosaic(floor.camera(), placed, {.metres_per_pixel = kPixel_m});
    write_geotiff(path("m.tif"), earth, plan, make_mosaics(floor, {&plan, 1}).front());
    const nlohmann::json info = gdal_info(path("m.tif"));
    EXPECT_EQ(info.at("size").at(0), plan.size.width);
    EXPECT_THAT(info.at("coordinateSystem").at("wkt").get<std::string>(),
                testing::HasSubstr("ID[\"EPSG\"," + std::to_string(earth.epsg()) + "]"));
    EXPECT_EQ(info.at("bands").at(0).at("noDataValue"), kUnseen);
    EXPECT_EQ(info.at("geoTransform").at(1), -info.at("geoTransform").at(5).get<double>());
    const Eigen::Vector2d pixel = middle_of_mark(read_by_gdal("m.tif"));
    const Eigen::Vector2d expected = gdal_projected(origin.latitude_deg, origin.longitude_deg,
                                                    origin.heading_deg, {mark}, earth.epsg())[0];
    const double off_m = (gdal_place(info, pixel.x(), pixel.y()) - expected).norm();
    EXPECT_LT(off_m, 0.5 * kPixel_m);
  }
}

// The picture with x up, by its world file: turned, and linear about its middle.
TEST_F(GeoTiffTest, TheWorldFilePutsTheMarkThereToo) {
  constexpr double kPixel_m = 0.1;
  const Eigen::Vector2d mark(402.0, -297.0);
  const std::vector<PlacedPicture> truth{{0, 20.0, {0, 0, 0}}, {1, 20.0, {400, -300, 2.0}}};
  const MarkedFloor floor(mark, truth);
  const MosaicPlan plan = plan_mosaic(floor.camera(), truth, {.metres_per_pixel = kPixel_m});
  const cv::Mat mosaic = make_mosaics(floor, {&plan, 1}).front();
  const Eigen::Vector2d pixel = middle_of_mark(mosaic);
  write_file(path("m.png"), encode_png(mosaic));
  for (const EarthOrigin& origin : kOrigins) {
    const EarthFrame earth(origin);
    write_file(path("m.pgw"), world_file(plan, cv::Rect({0, 0}, plan.size), earth));
    const Eigen::Vector2d expected = gdal_projected(origin.latitude_deg, origin.longitude_deg,
                                                    origin.heading_deg, {mark}, earth.epsg())[0];
    const nlohmann::json info = gdal_info(path("m.png"));
    EXPECT_LT((gdal_place(info, pixel.x(), pixel.y()) - expected).norm(), 0.5 * kPixel_m);
    // A part of it has the world file of its own first pixel.
    const cv::Rect part(37, 900, 100, 50);
    write_file(path("m.pgw"), world_file(plan, part, earth));
    const Eigen::Vector2d of_part =
        gdal_place(gdal_info(path("m.png")), pixel.x() - part.x, pixel.y() - part.y);
    EXPECT_LT((of_part - expected).norm(), 0.5 * kPixel_m);
  }
  write_file(path("m.pgw"), world_file(plan, cv::Rect({0, 0}, plan.size)));
  const Eigen::Vector2d in_map = gdal_place(gdal_info(path("m.png")), pixel.x(), pixel.y());
  EXPECT_LT((in_map - Eigen::Vector2d(-mark.y(), mark.x())).norm(), 0.5 * kPixel_m);
}

TEST_F(GeoTiffTest, TilesInAnyOrderAreTheWhole) {
  const std::vector<PlacedPicture> truth{{0, 20.0, {0, 0, 0}}, {1, 20.0, {60, -40, 2.0}}};
  const MarkedFloor floor({60, -40}, truth);
  const EarthFrame earth({39.5, 2.5, 213.0});
  const auto placed = placed_on_grid(earth, floor.camera(), truth);
  const MosaicPlan plan = plan_mosaic(floor.camera(), placed, {});
  const cv::Mat mosaic = make_mosaics(floor, {&plan, 1}).front();
  GeoTiff file(path("tiles.tif"), earth, plan, 64);
  int tiles = 0;
  make_tiles(floor, plan, {.side_px = 64, .cache_bytes = 0}, [&](const MosaicTile& tile) {
    file.write(tile);
    ++tiles;
  });
  file.finish();
  const int all = ((plan.size.width + 63) / 64) * ((plan.size.height + 63) / 64);
  EXPECT_LT(tiles, all);  // the two pictures are far apart
  const cv::Mat read = read_by_gdal("tiles.tif");
  ASSERT_EQ(read.size(), mosaic.size());
  EXPECT_EQ(cv::norm(read, mosaic, cv::NORM_INF), 0.0);
}

// Odd sides, tiles that are cut, and gaps: unseen pixels leave their neighbours as they are.
TEST_F(GeoTiffTest, OverviewsAreMeansOfWhatIsSeenByHalves) {
  const EarthFrame earth({39.5, 2.5, 213.0});
  MosaicPlan plan;
  plan.metres_per_pixel = 0.1;
  plan.size = {1061, 303};
  cv::Mat level(plan.size, CV_8U);
  cv::randu(level, 0, 255);
  cv::Mat gaps(plan.size, CV_8U);
  cv::randu(gaps, 0, 3);
  level.setTo(kUnseen, gaps == 0);
  level({500, 0, 130, 303}).setTo(kUnseen);
  write_geotiff(path("m.tif"), earth, plan, level);
  const nlohmann::json overviews = gdal_info(path("m.tif")).at("bands").at(0).at("overviews");
  ASSERT_EQ(overviews.size(), 3U);
  for (std::size_t i = 0; i <= overviews.size(); ++i) {
    const cv::Mat read = read_by_gdal("m.tif", i == 0 ? "NONE" : std::to_string(i - 1));
    ASSERT_EQ(read.size(), level.size()) << i;
    EXPECT_EQ(cv::norm(read, level, cv::NORM_INF), 0.0) << i;
    cv::Mat half((level.rows + 1) / 2, (level.cols + 1) / 2, CV_8U, cv::Scalar(kUnseen));
    for (int v = 0; v < half.rows; ++v) {
      for (int u = 0; u < half.cols; ++u) {
        const cv::Mat four = level(cv::Rect(2 * u, 2 * v, 2, 2) & cv::Rect({0, 0}, level.size()));
        const cv::Mat seen = four != kUnseen;
        if (cv::countNonZero(seen) == 0) continue;
        half.at<unsigned char>(v, u) =
            static_cast<unsigned char>(std::floor(cv::mean(four, seen)[0] + 0.5));
      }
    }
    level = half;
    if (i < overviews.size()) {
      EXPECT_EQ(overviews.at(i).at("size").at(0), level.cols);
    }
  }
}

TEST_F(GeoTiffTest, RefusesAFolderThatIsNotThere) {
  const std::vector<PlacedPicture> truth{{0, 20.0, {0, 0, 0}}};
  const MarkedFloor floor({0, 0}, truth);
  const EarthFrame earth({39.5, 2.5, 213.0});
  const MosaicPlan plan = plan_mosaic(floor.camera(), truth, {});
  EXPECT_THAT(test::input_error_of([&] { GeoTiff(path("none/m.tif"), earth, plan, 64); }),
              testing::HasSubstr("m.tif: cannot be written"));
  constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
  const std::vector<PlacedPicture> wild{{0, 20.0, {kNaN, 0, 0}}};
  EXPECT_THAT(test::input_error_of([&] { placed_on_grid(earth, floor.camera(), wild); }),
              testing::HasSubstr("100 km"));
}

}  // namespace
}  // namespace fathom

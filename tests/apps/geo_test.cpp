// Maps on Earth and mosaics by tiles, through the real program; GDAL reads them back.

#include <filesystem>
#include <fstream>
#include <sstream>

#include <gmock/gmock.h>

#include "apps/command_line.hpp"
#include "apps/graphs.hpp"
#include "fathom/core/files.hpp"
#include "fathom/report/earth_frame.hpp"
#include "harness/small_config.hpp"
#include "support/gdal.hpp"
#include "support/pictures.hpp"
#include "support/requirements.hpp"

namespace fathom::test {
namespace {

using ::testing::HasSubstr;

/// Without distortion, so that the four corners of a footprint are all of its outline.
std::string straight_survey() {
  std::string text = kSmallSurvey;
  const std::string bent = "[-0.05, 0.01, 0.001, -0.001, 0]";
  return text.replace(text.find(bent), bent.size(), "[0, 0, 0, 0, 0]");
}

std::string origin(double latitude, double longitude, double heading) {
  std::ostringstream text;
  text.precision(12);
  text << "dataset.origin: {latitude: " << latitude << ", longitude: " << longitude
       << ", heading: " << heading << "}\n";
  return text.str();
}

class Geo : public CommandLine {
 protected:
  std::string bytes_of(const std::string& name) const { return read_file(path(name)); }
  bool exists(const std::string& name) const { return std::filesystem::exists(path(name)); }
};

class OnEarth : public Geo {
 protected:
  void SetUp() override {
    FATHOM_REQUIRE_FEATURE("geotiff");
    if (!has_gdal()) GTEST_SKIP() << kNoGdal;
  }

  // The corners of all footprints of footprints.csv, in the map.
  std::vector<Eigen::Vector2d> footprint_corners(const std::string& file) const {
    std::ifstream lines(path(file));
    std::string line;
    std::getline(lines, line);
    std::vector<Eigen::Vector2d> corners;
    while (std::getline(lines, line)) {
      std::istringstream fields(line);
      std::vector<double> values;
      for (std::string field; std::getline(fields, field, ',') && values.size() < 10;) {
        values.push_back(std::stod(field));
      }
      for (std::size_t i = 2; i + 1 < values.size(); i += 2) {
        corners.emplace_back(values[i], values[i + 1]);
      }
    }
    return corners;
  }
};

// Each keyframe's picture is laid, so that the mosaic ends where the outermost corners are.
TEST_F(OnEarth, TheCornersOfTheGeoTiffLieWhereTheyShouldToAPixel) {
  struct Case {
    double latitude, longitude, heading;
    int epsg;
  };
  for (const Case& one : {Case{39.5, 2.5, 0.0, 32631}, Case{39.5, 2.5, 90.0, 32631},
                          Case{-33.86, 151.2, 213.0, 32756}, Case{10.0, 179.99999, 45.0, 32660}}) {
    SCOPED_TRACE(testing::Message() << one.epsg << ", heading " << one.heading);
    write("c.yaml", straight_survey() + origin(one.latitude, one.longitude, one.heading));
    EXPECT_THAT(fathom_done({"run", "c.yaml", "--out", "out"}).out,
                HasSubstr("mosaic.tif: WGS 84 / UTM zone"));
    Eigen::Vector2d low = Eigen::Vector2d::Constant(1e9);
    Eigen::Vector2d high = -low;
    for (const Eigen::Vector2d& place :
         gdal_projected(one.latitude, one.longitude, one.heading,
                        footprint_corners("out/footprints.csv"), one.epsg)) {
      low = low.cwiseMin(place);
      high = high.cwiseMax(place);
    }
    const nlohmann::json info = gdal_info(path("out/mosaic.tif"));
    const double pixel_m = info.at("geoTransform").at(1);
    const auto corner = [&](const char* name) {
      const auto at = info.at("cornerCoordinates").at(name).get<std::array<double, 2>>();
      return Eigen::Vector2d(at[0], at[1]);
    };
    const Eigen::Vector2d upper_left(low.x(), high.y());
    const Eigen::Vector2d lower_right(high.x(), low.y());
    EXPECT_LT((corner("upperLeft") - upper_left).cwiseAbs().maxCoeff(), pixel_m);
    EXPECT_LT((corner("lowerRight") - lower_right).cwiseAbs().maxCoeff(), pixel_m);
  }
}

TEST_F(OnEarth, ARunLeavesItsTrackLoopsAndFootprints) {
  write("c.yaml", std::string(kSmallSurvey) + origin(39.5, 2.5, 213));
  fathom_done({"run", "c.yaml", "--out", "out"});
  const nlohmann::json track = json_of("out/trajectory.geojson");
  ASSERT_EQ(track.at("features").size(), 12u);  // a line and 11 keyframes
  const nlohmann::json& line = track.at("features").at(0).at("geometry").at("coordinates");
  ASSERT_EQ(line.size(), 11u);
  EXPECT_EQ(line.at(0), (nlohmann::json{2.5, 39.5}));
  EXPECT_TRUE(track.at("features").at(5).at("properties").contains("sigma_x_m"));
  EXPECT_EQ(json_of("out/footprints.geojson").at("features").size(), 11u);
  EXPECT_EQ(json_of("out/loops.geojson").at("features").size(),
            json_of("out/metrics.json").at("loop_closures").get<std::size_t>());
  EXPECT_EQ(json_of("out/mosaic.json").at("world_file_epsg"), 32631);
  // A second run without an origin takes them away.
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out"});
  for (const std::string name :
       {"trajectory.geojson", "footprints.geojson", "loops.geojson", "mosaic.tif"}) {
    EXPECT_FALSE(exists("out/" + name)) << name;
  }
  EXPECT_TRUE(exists("out/footprints.csv"));
}

TEST_F(OnEarth, TheOriginChangesNoEstimateAndNoRegistration) {
  write("c.yaml", kSmallSurvey);
  write("e.yaml", std::string(kSmallSurvey) + origin(39.5, 2.5, 213));
  fathom_done({"run", "c.yaml", "--out", "c", "--cache", "cache"});
  const auto before = bytes_of("cache/registrations.sqlite").size();
  fathom_done({"run", "e.yaml", "--out", "e", "--cache", "cache"});
  EXPECT_EQ(bytes_of("cache/registrations.sqlite").size(), before);
  for (const std::string name : {"trajectory.tum", "measurements.g2o", "mosaic.png"}) {
    EXPECT_EQ(bytes_of("c/" + name), bytes_of("e/" + name)) << name;
  }
  EXPECT_EQ(json_of("c/run.json").at("data"), json_of("e/run.json").at("data"));
  EXPECT_FALSE(json_of("c/run.json").at("configuration").contains("dataset.origin.latitude"));
}

TEST_F(OnEarth, AnOlderRunIsPutOnEarthByTheMosaicCommand) {
  write("c.yaml", kSmallSurvey);
  write("e.yaml", std::string(kSmallSurvey) + origin(39.5, 2.5, 213));
  fathom_done({"run", "c.yaml", "--out", "c"});
  fathom_done({"run", "e.yaml", "--out", "e"});
  const Ended ended = fathom_done({"mosaic", "c", "--set", "dataset.origin.latitude=39.5", "--set",
                                   "dataset.origin.longitude=2.5", "--blend", "seams", "--set",
                                   "dataset.origin.heading=213", "--out", "later"});
  EXPECT_THAT(ended.out, HasSubstr("later/mosaic.tif (WGS 84 / UTM zone 31N)"));
  for (const std::string name :
       {"mosaic.tif", "mosaic.pgw", "mosaic.json", "footprints.csv", "footprints.geojson"}) {
    EXPECT_EQ(bytes_of("later/" + name), bytes_of("e/" + name)) << name;
  }
  // Of a run that knows its origin nothing needs to be said.
  fathom_done({"mosaic", "e", "--blend", "seams", "--out", "again"});
  EXPECT_EQ(bytes_of("again/mosaic.tif"), bytes_of("e/mosaic.tif"));
}

TEST_F(OnEarth, ComparedEstimatorsHaveOneEach) {
  write("c.yaml", std::string(kSmallSurvey) + origin(39.5, 2.5, 213) +
                      "estimators: [{type: ekf}, {type: incremental_smoother}]\n");
  fathom_done({"compare", "c.yaml", "--out", "out", "--no-cache"});
  for (const std::string name : {"ekf", "incremental_smoother"}) {
    EXPECT_EQ(gdal_info(path("out/" + name + "/mosaic.tif")).at("bands").size(), 1u);
    EXPECT_TRUE(exists("out/" + name + "/trajectory.geojson"));
    EXPECT_TRUE(exists("out/" + name + "/footprints.csv"));
  }
  EXPECT_THAT(bytes_of("out/report.html"), HasSubstr("data:image/jpeg;base64,"));
}

TEST_F(OnEarth, TilesAndOneFileAreTheSameGeoTiff) {
  write("c.yaml", std::string(kSmallSurvey) + origin(39.5, 2.5, 213));
  fathom_done({"run", "c.yaml", "--out", "out"});
  fathom_done({"mosaic", "out", "--tile-size", "64", "--blend", "seams", "--out", "tiles"});
  for (const std::string name : {"out", "tiles"}) {
    printed_by("gdal_translate -q -of PNG " + path(name + "/mosaic.tif").string() + " " +
               path(name + ".png").string());
  }
  EXPECT_EQ(bytes_of("out.png"), bytes_of("tiles.png"));
  EXPECT_EQ(gdal_info(path("out/mosaic.tif")).at("geoTransform"),
            gdal_info(path("tiles/mosaic.tif")).at("geoTransform"));
}

TEST_F(Geo, TilesPutTogetherAreTheMosaic) {
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out"});
  fathom_done({"mosaic", "out", "--tile-size", "100", "--blend", "seams", "--out", "tiles"});
  const cv::Mat whole = read_picture(path("out/mosaic.png"), cv::IMREAD_UNCHANGED);
  const nlohmann::json index = json_of("tiles/mosaic.json");
  EXPECT_EQ(index.at("tile_px"), 100);
  EXPECT_EQ(index.at("tiles").size(), 12u);
  EXPECT_EQ(index.at("width_px"), whole.cols);
  cv::Mat joined(whole.size(), CV_8U, cv::Scalar(255));
  for (const std::string name : index.at("tiles")) {
    int row = -1;
    int column = -1;
    ASSERT_EQ(std::sscanf(name.c_str(), "tiles/r%d_c%d.png", &row, &column), 2) << name;
    const cv::Mat tile = read_picture(path("tiles/" + name), cv::IMREAD_UNCHANGED);
    tile.copyTo(joined({column * 100, row * 100, tile.cols, tile.rows}));
    // Its world file: the middle of its first pixel, to the right (−y) and up (x).
    std::istringstream world(bytes_of("tiles/" + name.substr(0, name.size() - 4) + ".pgw"));
    std::array<double, 6> line{};
    for (double& value : line) world >> value;
    const double pixel_m = index.at("metres_per_pixel");
    EXPECT_EQ(line[0], pixel_m);
    EXPECT_EQ(line[1], 0.0);
    EXPECT_EQ(line[2], 0.0);
    EXPECT_EQ(line[3], -pixel_m);
    EXPECT_NEAR(line[4],
                -index.at("y_of_top_left_m").get<double>() + (100 * column + 0.5) * pixel_m, 1e-9);
    EXPECT_NEAR(line[5], index.at("x_of_top_left_m").get<double>() - (100 * row + 0.5) * pixel_m,
                1e-9);
  }
  EXPECT_EQ(cv::norm(joined, whole, cv::NORM_INF), 0.0);
  EXPECT_FALSE(exists("tiles/mosaic.png"));
  // One picture takes the place of the tiles.
  fathom_done({"mosaic", "out", "--out", "tiles"});
  EXPECT_FALSE(exists("tiles/tiles"));
  EXPECT_TRUE(exists("tiles/mosaic.png"));
}

TEST_F(Geo, BadOriginsAreRefused) {
  write("g.g2o", kTwoPoses);
  const std::vector<std::pair<std::string, std::string>> cases{
      {"dataset.origin: {latitude: 91, longitude: 0, heading: 0}", "latitude"},
      {"dataset.origin: {latitude: 0, longitude: 181, heading: 0}", "longitude"},
      {"dataset.origin: {latitude: 0, longitude: 0, heading: 400}", "heading"},
      {"dataset.origin: {latitude: nan, longitude: 0, heading: 0}", "latitude"},
      {"dataset.origin: {latitude: 10, longitude: 0}", "dataset.origin.heading: is missing"},
      {"dataset.origin: {latitude: 10}", "c.yaml:14: dataset.origin.longitude: is missing"},
      {"dataset.origin: {lat: 10}", "unknown key 'dataset.origin.lat'"},
      {"dataset.origin: 10", "expected a map"}};
  for (const auto& [line, message] : cases) {
    write("c.yaml", std::string(kSmallSurvey) + line + "\n");
    EXPECT_THAT(refusal({"run", "c.yaml", "--out", "new"}), HasSubstr(message)) << line;
  }
  write("c.yaml",
        "dataset: {type: g2o, path: g.g2o, origin: {latitude: 1, longitude: 1, heading: 0}}\n");
  EXPECT_THAT(refusal({"run", "c.yaml", "--out", "new"}), HasSubstr("unknown key 'dataset.origin"));
  write("c.yaml", kSmallSurvey);
  fathom_done({"run", "c.yaml", "--out", "out"});
  for (const std::string size : {"0", "-5", "63", "100000", "x"}) {
    EXPECT_THAT(refusal({"mosaic", "out", "--tile-size", size, "--out", "new"}),
                HasSubstr("--tile-size"))
        << size;
  }
}

}  // namespace
}  // namespace fathom::test

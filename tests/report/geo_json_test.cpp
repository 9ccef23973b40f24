#include "fathom/report/geo_json.hpp"

#include <cmath>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include "support/input_error.hpp"
#include "support/requirements.hpp"

namespace fathom {
namespace {

using nlohmann::json;

class GeoJsonTest : public ::testing::Test {
 protected:
  void SetUp() override { FATHOM_REQUIRE_FEATURE("geotiff"); }
  static EarthFrame earth() { return EarthFrame({0.0, 20.0, 90.0}); }
};

// On the equator 1 m east is 1 / 6378137 rad, and 1 m north 1 / 6335439 (radius of the meridian).
constexpr double kEast_deg = 180.0 / 3.14159265358979323846 / 6378137.0;
constexpr double kNorth_deg = 180.0 / 3.14159265358979323846 / 6335439.327;

TEST_F(GeoJsonTest, TheTrackIsLongitudeFirst) {
  Eigen::Matrix3d covariance = Eigen::Matrix3d::Zero();
  covariance.diagonal() << 0.04, 0.09, 1e-4;
  const std::vector<TrackPoint> track{{1'500'000'000, {0, 0, 0}, std::nullopt},
                                      {2'500'000'000, {100, 30, 0.5}, covariance}};
  const json all = json::parse(track_geojson(earth(), track));
  EXPECT_EQ(all.at("type"), "FeatureCollection");
  EXPECT_FALSE(all.contains("crs"));
  ASSERT_EQ(all.at("features").size(), 3u);
  const json& line = all.at("features").at(0).at("geometry");
  EXPECT_EQ(line.at("type"), "LineString");
  EXPECT_EQ(line.at("coordinates").at(0), (json{20.0, 0.0}));
  // Heading east: 100 m ahead are east, 30 m to port are north.
  EXPECT_NEAR(line.at("coordinates").at(1).at(0), 20.0 + 100 * kEast_deg, 2e-9);
  EXPECT_NEAR(line.at("coordinates").at(1).at(1), 30 * kNorth_deg, 2e-9);
  const json& point = all.at("features").at(2);
  EXPECT_EQ(point.at("geometry").at("coordinates"), line.at("coordinates").at(1));
  const json& properties = point.at("properties");
  EXPECT_EQ(properties.at("keyframe"), 1);
  EXPECT_EQ(properties.at("time_s"), 2.5);
  EXPECT_EQ(properties.at("x_m"), 100.0);
  EXPECT_NEAR(properties.at("heading_deg"), 90.0 - 0.5 * 180.0 / 3.14159265358979, 1e-6);
  EXPECT_NEAR(properties.at("sigma_x_m"), 0.2, 1e-12);
  EXPECT_NEAR(properties.at("sigma_y_m"), 0.3, 1e-12);
  EXPECT_NEAR(properties.at("sigma_heading_deg"), 0.01 * 180.0 / 3.14159265358979, 1e-9);
  EXPECT_FALSE(all.at("features").at(1).at("properties").contains("sigma_x_m"));
}

TEST_F(GeoJsonTest, ASingleKeyframeHasNoLine) {
  const std::vector<TrackPoint> track{{0, {0, 0, 0}, std::nullopt}};
  const json all = json::parse(track_geojson(earth(), track));
  ASSERT_EQ(all.at("features").size(), 1u);
  EXPECT_EQ(all.at("features").at(0).at("geometry").at("type"), "Point");
  EXPECT_THAT(test::input_error_of([&] { track_geojson(earth(), {}); }),
              testing::HasSubstr("at least one"));
}

TEST_F(GeoJsonTest, LoopsJoinTheirKeyframes) {
  const std::vector<TrackPoint> track{
      {0, {0, 0, 0}, {}}, {1, {10, 0, 0}, {}}, {2, {10, 10, 0}, {}}};
  const std::vector<TrackLoop> loops{{0, 2, "used"}, {1, 2, "rejected"}};
  const json all = json::parse(loops_geojson(earth(), track, loops));
  ASSERT_EQ(all.at("features").size(), 2u);
  EXPECT_EQ(all.at("features").at(1).at("properties"),
            (json{{"from", 1}, {"to", 2}, {"fate", "rejected"}}));
  EXPECT_EQ(all.at("features").at(0).at("geometry").at("coordinates").size(), 2u);
  EXPECT_EQ(json::parse(loops_geojson(earth(), track, {})).at("features").size(), 0u);
}

double twice_area(const json& ring) {
  double sum = 0.0;
  for (std::size_t i = 0; i + 1 < ring.size(); ++i) {
    const auto at = [&](std::size_t k, int c) {
      return ring.at(k).at(c).get<double>() - ring.at(0).at(c).get<double>();
    };
    sum += at(i, 0) * at(i + 1, 1) - at(i, 1) * at(i + 1, 0);
  }
  return sum;
}

Footprint square(double x, double y, double half_m) {
  // Clockwise seen from above, as the corners of a picture are.
  return {3,
          4'000'000'000,
          {Eigen::Vector2d(x + half_m, y + half_m), Eigen::Vector2d(x + half_m, y - half_m),
           Eigen::Vector2d(x - half_m, y - half_m), Eigen::Vector2d(x - half_m, y + half_m)},
          0.5,
          0.25,
          7};
}

TEST_F(GeoJsonTest, FootprintsAreClosedCounterClockwiseRings) {
  const std::vector<Footprint> one{square(10, 20, 2)};
  const json feature = json::parse(footprints_geojson(earth(), one)).at("features").at(0);
  EXPECT_EQ(feature.at("geometry").at("type"), "Polygon");
  const json& ring = feature.at("geometry").at("coordinates").at(0);
  ASSERT_EQ(ring.size(), 5u);
  EXPECT_EQ(ring.front(), ring.back());
  EXPECT_NEAR(twice_area(ring), 2 * 16 * kEast_deg * kNorth_deg, 1e-3 * 16 * kEast_deg * kEast_deg);
  EXPECT_EQ(feature.at("properties"), (json{{"keyframe", 3},
                                            {"time_s", 4.0},
                                            {"overlap_previous", 0.5},
                                            {"overlap_other_pass", 0.25},
                                            {"other_pass", 7}}));
}

// RFC 7946, 3.1.9.
TEST_F(GeoJsonTest, WhatCrossesTheAntimeridianIsCut) {
  for (const double start : {180.0, -180.0}) {
    const EarthFrame edge({0.0, start, 90.0});  // x is east
    const std::vector<TrackPoint> track{
        {0, {-40, 0, 0}, {}}, {1, {-20, 10, 0}, {}}, {2, {20, 10, 0}, {}}, {3, {-10, 20, 0}, {}}};
    const json all = json::parse(track_geojson(edge, track));
    const json& geometry = all.at("features").at(0).at("geometry");
    ASSERT_EQ(geometry.at("type"), "MultiLineString");
    ASSERT_EQ(geometry.at("coordinates").size(), 3u);
    for (const json& part : geometry.at("coordinates")) {
      const bool is_east = part.at(1).at(0).get<double>() > 0.0;
      for (const json& place : part) {
        EXPECT_LE(std::abs(place.at(0).get<double>()), 180.0);
        EXPECT_GT(std::abs(place.at(0).get<double>()), 179.9);
        EXPECT_EQ(place.at(0).get<double>() > 0.0, is_east) << all;
      }
    }
    EXPECT_NEAR(geometry.at("coordinates").at(0).at(2).at(1), 10 * kNorth_deg, 2e-9);

    const std::vector<Footprint> across{square(1, 0, 2)};
    const json polygon =
        json::parse(footprints_geojson(edge, across)).at("features").at(0).at("geometry");
    ASSERT_EQ(polygon.at("type"), "MultiPolygon");
    ASSERT_EQ(polygon.at("coordinates").size(), 2u);
    double sum = 0.0;
    for (const json& part : polygon.at("coordinates")) {
      EXPECT_EQ(part.at(0).front(), part.at(0).back());
      EXPECT_GT(twice_area(part.at(0)), 0.0);
      sum += twice_area(part.at(0));
    }
    EXPECT_NEAR(sum / (2 * kEast_deg * kNorth_deg), 16.0, 0.02);
    // A quarter of it lies west of the antimeridian.
    EXPECT_NEAR(twice_area(polygon.at("coordinates").at(0).at(0)) / sum, 0.25, 0.01);
  }
}

}  // namespace
}  // namespace fathom

#include "fathom/report/trajectory_plot.hpp"

#include <cmath>
#include <limits>
#include <numeric>
#include <string>
#include <vector>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/core/random.hpp"
#include "fathom/report/picture.hpp"
#include "fathom/vision/picture_codecs.hpp"
#include "pixels.hpp"
#include "report/plot_series.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::count;
using test::input_error_of;
using test::map_of;
using test::mean_position;
using test::same;
using test::series_of;
using test::where_nearly;
using testing::HasSubstr;
using testing::Not;

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
constexpr double kInfinity = std::numeric_limits<double>::infinity();

TrajectoryPlot plot_of(std::vector<PlotSeries> series, const std::string& title = "title") {
  TrajectoryPlot plot;
  plot.title = title;
  plot.series = std::move(series);
  return plot;
}

cv::Mat render(const TrajectoryPlot& plot) {
  return decode_picture(trajectory_png(plot));
}

// Texts are glyphs, so that a title is no markup.
TEST(TrajectoryPlot, AnSvgHasTheSameLinesOnASmallerPage) {
  const std::string svg =
      trajectory_svg(plot_of({series_of(0, {{0, 0, 0}, {10, 0, 0}})}, "<script>"));
  EXPECT_THAT(svg, HasSubstr("<svg "));
  EXPECT_THAT(svg, HasSubstr("viewBox=\"0 0 480 360\""));
  EXPECT_THAT(svg, Not(HasSubstr("<script>")));
  EXPECT_THAT(svg, testing::ContainsRegex("rgb\\(0%, ?44\\.7"));  // its blue
  TrajectoryPlot broken = plot_of({series_of(0, {{0, 0, 0}})});
  broken.series[0].loops = {{0, 1}};
  EXPECT_THAT(input_error_of([&] { trajectory_svg(broken); }), HasSubstr("only 1 poses"));
}

// Three marks, told apart by the colour of their series: the origin, a point 10 m ahead of it and
// one 10 m to port.
TEST(TrajectoryPlot, XIsUpYIsToTheLeftAndTheAxesAreEqual) {
  const cv::Mat map = map_of(
      render(plot_of({series_of(0, {{0, 0, 0}, {0, 0, 0}}), series_of(1, {{10, 0, 0}, {10, 0, 0}}),
                      series_of(2, {{0, 10, 0}, {0, 10, 0}})})));
  const Eigen::Vector2d origin = mean_position(map, palette::blue);
  const Eigen::Vector2d ahead = mean_position(map, palette::vermillion) - origin;
  const Eigen::Vector2d to_port = mean_position(map, palette::green) - origin;
  EXPECT_LT(ahead.y(), -300);
  EXPECT_NEAR(ahead.x(), 0, 1.0);
  EXPECT_LT(to_port.x(), -300);
  EXPECT_NEAR(to_port.y(), 0, 1.0);
  EXPECT_NEAR(to_port.norm(), ahead.norm(), 1.5);
}

TEST(TrajectoryPlot, WhereEstimatesLieOnOneAnotherTheirColoursTakeTurns) {
  const std::vector<Pose> path{{0, 0, 0}, {40, 0, 0}, {40, 5, 0}};
  const std::vector<PlotSeries> all{series_of(0, path), series_of(1, path), series_of(2, path)};
  const cv::Mat map = map_of(render(plot_of(all)));
  std::vector<double> pixels;
  for (const PlotSeries& one : all) {
    pixels.push_back(cv::countNonZero(where_nearly(map, one.style.colour, 30)));
  }
  const double sum = std::accumulate(pixels.begin(), pixels.end(), 0.0);
  EXPECT_THAT(pixels, testing::Each(testing::DoubleNear(sum / 3.0, 0.15 * sum)));
}

TEST(TrajectoryPlot, IsRepeatable) {
  const TrajectoryPlot plot = plot_of({series_of(0, {{0, 0, 0}, {5, 1, 0}})});
  EXPECT_TRUE(same(render(plot), render(plot)));
  EXPECT_EQ(render(plot).type(), CV_8UC3);
}

// A square map, a wide one, a tall one, one without a size and one without poses.
TEST(TrajectoryPlot, HasTheShapeOfItsMapAndIsFilledByIt) {
  const auto size = [](const std::vector<Pose>& poses) {
    return render(plot_of({series_of(0, poses)})).size();
  };
  EXPECT_EQ(size({{0, 0, 0}, {12, 9, 0}}).height, 1600);
  EXPECT_NEAR(size({{0, 0, 0}, {12, 9, 0}}).width, 2.5 * (60.0 + 0.75 * 555.0), 2.0);
  EXPECT_EQ(size({{0, 0, 0}, {1, 10, 0}}), cv::Size(1600, 800));
  EXPECT_EQ(size({{0, 0, 0}, {10, 1, 0}}), cv::Size(1000, 1600));
  EXPECT_EQ(size({{3, 4, 0}}), cv::Size(1000, 800));
  EXPECT_EQ(size({}), cv::Size(1000, 800));
  const cv::Mat map = map_of(render(plot_of({series_of(1, {{0, 0, 0}, {12, 9, 0}})})));
  const cv::Rect drawn = cv::boundingRect(test::where(map, palette::vermillion));
  EXPECT_GT(drawn.width * drawn.height, 0.6 * map.rows * map.cols);
}

// A run that has gone to the moon would leave the others a point.
TEST(TrajectoryPlot, WhatMayLeaveDoesNotDecideTheScale) {
  TrajectoryPlot plot =
      plot_of({series_of(0, {{0, 0, 0}, {0, 10, 0}}), series_of(1, {{0, 0, 0}, {5e5, 3e5, 0}})});
  const auto width = [](const cv::Mat& map) {
    return cv::boundingRect(test::where(map, palette::blue)).width;
  };
  EXPECT_LT(width(map_of(render(plot))), 20);
  plot.series[1].may_leave = true;
  EXPECT_GT(width(map_of(render(plot))), 600);
}

TEST(TrajectoryPlot, LoopsAndEllipsesAreDrawn) {
  TrajectoryPlot plot = plot_of({series_of(1, {{0, 0, 0}, {5, 0, 0}, {5, 5, 0}, {0, 5, 0}})});
  const cv::Mat bare = render(plot);
  plot.series[0].loops = {{0, 3}};
  const cv::Mat with_loop = render(plot);
  EXPECT_FALSE(same(map_of(bare), map_of(with_loop)));
  plot.series[0].covariances.assign(4, 0.05 * Eigen::Matrix3d::Identity());
  const cv::Mat with_ellipse = render(plot);
  EXPECT_FALSE(same(map_of(with_loop), map_of(with_ellipse)));
}

// σ of 1 m and 0.25 m: the outline reaches 2 m up and down, 0.5 m to either side.
TEST(TrajectoryPlot, TheEllipseIsTwoSigma) {
  PlotSeries series = series_of(1, {{0, 0, 0}});
  series.covariances = {Eigen::Vector3d(1.0, 0.0625, 1.0).asDiagonal()};
  TrajectoryPlot plot = plot_of({series, series_of(2, {{4, 0, 0}}), series_of(0, {{-4, 0, 0}})});
  const cv::Mat map = map_of(render(plot));
  const double pixels_per_metre =
      (mean_position(map, palette::blue).y() - mean_position(map, palette::green).y()) / 8.0;
  const Eigen::Vector2d centre = mean_position(map, palette::vermillion);
  cv::Mat not_white;
  cv::inRange(map, cv::Scalar(0, 60, 150), cv::Scalar(140, 190, 245), not_white);
  const auto is_drawn = [&](double up_m, double left_m) {
    const int v = static_cast<int>(std::lround(centre.y() - up_m * pixels_per_metre));
    const int u = static_cast<int>(std::lround(centre.x() - left_m * pixels_per_metre));
    return cv::countNonZero(not_white(cv::Rect(u - 2, v - 2, 5, 5))) > 0;
  };
  EXPECT_TRUE(is_drawn(2, 0));
  EXPECT_TRUE(is_drawn(-2, 0));
  EXPECT_TRUE(is_drawn(0, 0.5));
  EXPECT_TRUE(is_drawn(0, -0.5));
  EXPECT_FALSE(is_drawn(1, 0));
  EXPECT_FALSE(is_drawn(3, 0));
  EXPECT_FALSE(is_drawn(0, 1));
}

TEST(TrajectoryPlot, PosesThatAreNotFiniteBreakTheLineAndAreCounted) {
  const std::vector<Pose> whole{{0, 0, 0}, {0, 5, 0}, {0, 10, 0}, {0, 15, 0}, {0, 20, 0}};
  std::vector<Pose> broken = whole;
  const cv::Mat all = render(plot_of({series_of(1, whole)}));
  for (const Pose& bad : {Pose{kNaN, 10, 0}, Pose{0, kInfinity, 0}, Pose{0, 10, kNaN},
                          Pose{1e300, 10, 0}, Pose{0, -2e9, 0}}) {
    broken[2] = bad;
    const cv::Mat picture = render(plot_of({series_of(1, broken)}));
    EXPECT_LT(count(picture, palette::vermillion), 0.7 * count(all, palette::vermillion));
    // The title says so.
    EXPECT_FALSE(same(picture.rowRange(0, 60), all.rowRange(0, 60)));
  }
}

TEST(TrajectoryPlot, OddTrajectories) {
  std::vector<Pose> many;
  RandomStream random(1, "walk");
  Pose pose;
  for (int k = 0; k < 10'000; ++k) {
    many.push_back(pose);
    pose = compose(pose, {0.1, 0, 0.3 * random.normal()});
  }
  for (const auto& poses :
       std::vector<std::vector<Pose>>{{},
                                      {{1, 2, 0}},
                                      std::vector<Pose>(50, Pose{4e6, -3e5, 1}),
                                      {{1e9, 1e9, 0}, {-1e9, -1e9, 0}},
                                      {{0, 0, 0}, {1e-12, 0, 0}},
                                      {{1e9, 0, 0}, {1e9 + 1e-6, 0, 0}},
                                      std::vector<Pose>(3, Pose{kNaN, kNaN, kNaN}),
                                      many}) {
    for (const LineStyle& style : {estimator_style(1), dead_reckoning_style()}) {
      PlotSeries series = series_of(1, poses);
      series.style = style;
      if (poses.size() > 1) series.loops = {{0, poses.size() - 1}};
      for (const double variance : {0.0, 1e-6, 1e30, kNaN, -1.0}) {
        series.covariances.assign(poses.size(), variance * Eigen::Matrix3d::Identity());
        if (poses.size() > 100 && variance != 1e-6) continue;  // once is enough
        EXPECT_GE(render(plot_of({series})).rows, 800);
      }
    }
  }
}

TEST(TrajectoryPlot, AwkwardTexts) {
  TrajectoryPlot plot = plot_of({series_of(0, {{0, 0, 0}, {1, 0, 0}})});
  plot.series[0].name = "été\n2σ \xc3(";
  for (const std::string& title :
       {std::string(), std::string(2000, 'W'), std::string("a\n\tβ\xff")}) {
    plot.title = title;
    EXPECT_EQ(render(plot).size(), cv::Size(1000, 1600));
  }
  // More entries than one row takes.
  plot.series.assign(40, series_of(0, {{0, 0, 0}, {1, 0, 0}}));
  for (PlotSeries& series : plot.series) series.name = "a rather long name of a series";
  EXPECT_EQ(render(plot).size(), cv::Size(1000, 1600));
}

TEST(TrajectoryPlot, Refuses) {
  TrajectoryPlot plot = plot_of({series_of(1, {{0, 0, 0}, {1, 0, 0}})});
  const auto error = [&] { return input_error_of([&] { render(plot); }); };
  plot.series[0].covariances.resize(3);
  EXPECT_THAT(error(), HasSubstr("2 poses and 3 covariances"));
  plot.series[0].covariances.clear();
  plot.series[0].loops = {{0, 2}};
  EXPECT_THAT(error(), HasSubstr("loop from pose 0 to 2, but only 2 poses"));
}

TEST(EncodePng, DecodesToTheSamePicture) {
  const cv::Mat picture = render(plot_of({series_of(1, {{0, 0, 0}, {1, 1, 0}})}));
  const std::string png = encode_png(picture);
  EXPECT_EQ(png.substr(1, 3), "PNG");
  EXPECT_TRUE(same(decode_picture(png), picture));
  EXPECT_THAT(input_error_of([] { encode_png({}); }), HasSubstr("empty"));
  EXPECT_THAT(input_error_of([] { encode_png(cv::Mat(2, 2, CV_32FC3)); }),
              HasSubstr("got 32 bits and 3 channels"));
}

}  // namespace
}  // namespace fathom

// Fixes and headings on trajectory.png and the maps for print: where they are, and what they say.

#include "src/report/absolute_marks.hpp"

#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include "fathom/vision/picture_codecs.hpp"
#include "pixels.hpp"
#include "report/plot_series.hpp"
#include "support/input_error.hpp"

namespace fathom {
namespace {

using test::count;
using test::map_of;
using test::mean_position;
using test::series_of;
using test::where;
using testing::ElementsAre;
using testing::HasSubstr;

AbsoluteMark fix(std::size_t pose, const Eigen::Vector2d& at, bool is_kept) {
  return absolute_mark(AbsolutePose::position(pose, at, Eigen::Matrix2d::Identity()), is_kept);
}

AbsoluteMark heading(std::size_t pose, double heading_rad, bool is_kept) {
  return absolute_mark(AbsolutePose::heading(pose, heading_rad, 0.1), is_kept);
}

// A picture of marks on poses at (0, 0), with a blue, a green and a purple point at the origin, 10
// m ahead and 10 m to port.
class Map {
 public:
  explicit Map(std::vector<AbsoluteMark> marks) {
    TrajectoryPlot plot;
    plot.series = {series_of(0, {{0, 0, 0}, {0, 0, 0}}), series_of(2, {{10, 0, 0}, {10, 0, 0}}),
                   series_of(3, {{0, 10, 0}, {0, 10, 0}})};
    plot.series[0].absolute = std::move(marks);
    picture_ = map_of(decode_picture(trajectory_png(plot), cv::IMREAD_COLOR));
    origin_ = mean_position(picture_, palette::blue);
    ahead_ = (mean_position(picture_, palette::green) - origin_) / 10.0;
    to_port_ = (mean_position(picture_, palette::purple) - origin_) / 10.0;
  }

  const cv::Mat& picture() const { return picture_; }
  double pixels_per_metre() const { return ahead_.norm(); }
  /// Whether crimson is within a pixel of that place of the world.
  bool is_red_at(double x, double y) const {
    const Eigen::Vector2d at = origin_ + x * ahead_ + y * to_port_;
    const cv::Rect window(static_cast<int>(std::lround(at.x())) - 1,
                          static_cast<int>(std::lround(at.y())) - 1, 3, 3);
    return cv::countNonZero(where(picture_, palette::crimson)(window)) > 0;
  }
  /// The mean direction of crimson from the origin, (right, down).
  Eigen::Vector2d red_direction() const {
    return (mean_position(picture_, palette::crimson) - origin_).normalized();
  }

 private:
  cv::Mat picture_;
  Eigen::Vector2d origin_;
  Eigen::Vector2d ahead_;
  Eigen::Vector2d to_port_;
};

TEST(AbsoluteMarks, AFixIsWhereItSaysThatThePoseIs) {
  const Map map({fix(0, {4, 7}, false)});
  EXPECT_TRUE(map.is_red_at(4, 7));
  for (const auto& [x, y] : {std::pair(7, 4), std::pair(4, 5), std::pair(2, 7), std::pair(6, 9)}) {
    EXPECT_FALSE(map.is_red_at(x, y)) << x << " " << y;
  }
  // The line to it.
  const Eigen::Vector2d toward = Eigen::Vector2d(-7, -4).normalized();
  EXPECT_GT(map.red_direction().dot(toward), 0.999);
}

TEST(AbsoluteMarks, WhatIsKeptIsARingAndNotRed) {
  const Map bare({});
  const Map map({fix(0, {4, 7}, true), heading(0, 0.3, true)});
  EXPECT_EQ(count(map.picture(), palette::crimson), 0);
  EXPECT_FALSE(test::same(bare.picture(), map.picture()));
  // A cross has ink at its middle, a ring none; but the line to it ends there.
  EXPECT_GT(count(Map({fix(0, {4, 7}, false)}).picture(), palette::crimson), 0);
}

// x is up and y to the left: a heading of 2 rad points to the left and a little down.
TEST(AbsoluteMarks, AHeadingPointsWhereItIsMeasured) {
  for (const double heading_rad : {0.0, M_PI / 2, 2.0, -2.0, M_PI, -0.4}) {
    const Eigen::Vector2d expected(-std::sin(heading_rad), -std::cos(heading_rad));
    const Map map({heading(0, heading_rad, false)});
    EXPECT_GT(map.red_direction().dot(expected), 0.99) << heading_rad;
  }
}

// A pose at 10 m with marks of its own: they hang on it, not on the first one.
TEST(AbsoluteMarks, HangOnTheirPose) {
  TrajectoryPlot plot;
  plot.series = {series_of(0, {{0, 0, 0}, {0, 10, 0}})};
  plot.series[0].absolute = {heading(1, 0.0, false)};
  const cv::Mat picture = map_of(decode_picture(trajectory_png(plot), cv::IMREAD_COLOR));
  EXPECT_LT(mean_position(picture, palette::crimson).x(), 400);
}

TEST(AbsoluteMarks, AFarFixLeavesTheScaleAndIsAnArrowAtTheEdge) {
  const double scale = Map({}).pixels_per_metre();
  EXPECT_NEAR(Map({fix(0, {0, 1000}, false)}).pixels_per_metre(), scale, 0.01 * scale);
  EXPECT_LT(Map({fix(0, {12.4, 0}, false)}).pixels_per_metre(), 0.95 * scale);
  EXPECT_TRUE(Map({fix(0, {12.4, 0}, false)}).is_red_at(12.4, 0));
  // A head of 5 × 4.4 points is some 70 pixels; a dashed line has a few.
  for (const Eigen::Vector2d& far :
       {Eigen::Vector2d(3, 1000), Eigen::Vector2d(1e8, -50), Eigen::Vector2d(300, -900)}) {
    const cv::Mat red = where(Map({fix(0, far, false)}).picture(), palette::crimson);
    cv::Mat solid;
    cv::erode(red, solid, cv::Mat::ones(4, 4, CV_8U));
    EXPECT_GT(cv::countNonZero(solid), 0) << far.transpose();
  }
}

TEST(AbsoluteMarks, NumbersThatAreNotFiniteAreLeftOut) {
  AbsoluteMark mark = fix(0, {1, 1}, false);
  mark.measured.position = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
  mark.measured.heading_rad = std::numeric_limits<double>::infinity();
  EXPECT_EQ(count(Map({mark}).picture(), palette::crimson), 0);
}

TEST(AbsoluteMarks, ManyAreThinnedButWhatWasLeftOutIsDrawn) {
  std::vector<AbsoluteMark> marks;
  for (std::size_t k = 0; k < 1000; ++k) marks.push_back(heading(k, 0.1, k % 100 != 50));
  for (std::size_t k = 0; k < 400; ++k) marks.push_back(fix(k, {1, 1}, k % 100 != 50));
  const std::vector<std::size_t> drawn = drawn_marks(marks);
  const auto count_of = [&](bool is_kept, bool is_fix) {
    return std::ranges::count_if(drawn, [&](std::size_t i) {
      return marks[i].is_kept == is_kept && marks[i].measured.position.has_value() == is_fix;
    });
  };
  EXPECT_EQ(count_of(false, false), 10);
  EXPECT_EQ(count_of(false, true), 4);
  EXPECT_NEAR(count_of(true, false), 60, 2);
  EXPECT_NEAR(count_of(true, true), 133, 2);  // every third of 396
  EXPECT_LE(drawn_marks(marks, MarkLimits().within(120)).size(), 120U);
}

std::vector<std::string> legend_of(const std::vector<PlotSeries>& series) {
  std::vector<std::string> texts;
  const Eigen::AlignedBox2d shown(Eigen::Vector2d(-5, -5), Eigen::Vector2d(5, 5));
  for (const LegendEntry& entry : absolute_legend(series, shown)) texts.push_back(entry.text);
  return texts;
}

TEST(AbsoluteMarks, TheLegendSaysWhatThereIs) {
  PlotSeries series = series_of(0, std::vector<Pose>(200));
  EXPECT_THAT(legend_of({series}), ElementsAre());
  for (std::size_t k = 0; k < 200; ++k) series.absolute.push_back(heading(k, 0.1, true));
  series.absolute.push_back(fix(3, {1, 1}, true));
  const auto headings = drawn_marks(series.absolute).size() - 1;
  const std::string thinned = "measured heading (" + std::to_string(headings) + " of 200)";
  EXPECT_THAT(legend_of({series}), ElementsAre("fix", thinned));
  series.absolute.push_back(fix(3, {9, 1}, false));
  series.absolute.push_back(heading(3, 0.1, false));
  series.absolute_of = "ekf";
  EXPECT_THAT(legend_of({series}),
              ElementsAre("fix", "fix left out by ekf, an arrow if beyond the map", thinned,
                          "heading left out by ekf"));
}

TEST(AbsoluteMarks, AWholePoseIsAFixAndAHeading) {
  PlotSeries series = series_of(0, {{0, 0, 0}});
  const Eigen::Matrix3d covariance = Eigen::Matrix3d::Identity();
  series.absolute = {absolute_mark(AbsolutePose::from_covariance(0, {1, 2, 3}, covariance), true)};
  EXPECT_THAT(legend_of({series}), ElementsAre("fix", "measured heading"));
}

TEST(AbsoluteMarks, OfSeveralEstimatesThoseOfTheFirstThatLeftOneOut) {
  std::vector<PlotSeries> all{series_of(0, {Pose()}), series_of(1, {Pose()}),
                              series_of(2, {Pose()}), series_of(3, {Pose()})};
  keep_one_set_of_marks(all);
  EXPECT_TRUE(all[1].absolute_of.empty());
  for (const std::size_t i : {1, 2, 3}) all[i].absolute = {fix(0, {1, 1}, true)};
  auto plain = all;
  keep_one_set_of_marks(plain);
  EXPECT_EQ(plain[1].absolute_of, "estimator 1");
  EXPECT_EQ(plain[1].absolute.size(), 1U);
  EXPECT_TRUE(plain[2].absolute.empty());
  all[2].absolute[0].is_kept = false;
  keep_one_set_of_marks(all);
  EXPECT_TRUE(all[1].absolute.empty());
  EXPECT_EQ(all[2].absolute_of, "estimator 2");
  EXPECT_TRUE(all[3].absolute.empty());
}

TEST(AbsoluteMarks, OfAPoseThatIsNotThereAreRefused) {
  TrajectoryPlot plot;
  plot.series = {series_of(1, {{0, 0, 0}, {1, 0, 0}})};
  plot.series[0].absolute = {heading(2, 0.0, true)};
  EXPECT_THAT(test::input_error_of([&] { trajectory_png(plot); }),
              HasSubstr("measurement of pose 2, but only 2 poses"));
}

}  // namespace
}  // namespace fathom

// The errors of trajectories are those that evo gives (tests/evaluation/evo/record.py).

#include <cmath>
#include <map>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include "fathom/core/files.hpp"
#include "fathom/core/text.hpp"
#include "fathom/evaluation/error_statistics.hpp"
#include "fathom/evaluation/spatial_accuracy.hpp"
#include "fathom/measurements/g2o.hpp"
#include "support/data.hpp"
#include "support/temporary_folder.hpp"

namespace fathom {
namespace {

const std::filesystem::path kFolder =
    std::filesystem::path(FATHOM_SOURCE_DIR) / "tests/evaluation/evo";

struct Recorded {
  std::string alignment;
  std::string error;
  std::vector<double> figures;  ///< rmse, mean, median, std, min, max, sse
};

// The lines of one pair; the third party's command ends each.
std::vector<Recorded> recorded_of(const std::string& pair) {
  const std::string content = read_file(kFolder / "figures.csv");
  std::vector<Recorded> all;
  for (const std::string_view line : split(content, "\n")) {
    const auto fields = split_csv(line);
    const auto words = split(fields[0]);
    if (words[0] != pair) continue;
    all.push_back({std::string(words[1]), std::string(words[2]), {}});
    for (std::size_t i = 1; i <= 7; ++i)
      all.back().figures.push_back(parse_real(fields[i]).value());
  }
  return all;
}

struct SpatialPair {
  std::vector<StampedSpatialPose> estimate;
  std::vector<StampedSpatialPose> reference;
  Plane plane = Plane::xy;
};

std::vector<StampedPose> stamps_of(const std::vector<StampedSpatialPose>& poses) {
  std::vector<StampedPose> stamps;
  for (const StampedSpatialPose& pose : poses) stamps.push_back({pose.time_ns, {}});
  return stamps;
}

SpatialPair pair_of(const std::filesystem::path& estimate, const std::filesystem::path& reference) {
  const SpatialTrajectory first = read_trajectory({estimate, {}, {}});
  const SpatialTrajectory second = read_trajectory({reference, {}, {}});
  SpatialPair pair;
  pair.plane = usual_plane(second.format);
  for (const auto& [e, r] : associate(stamps_of(first.poses), stamps_of(second.poses), 0.01)) {
    pair.estimate.push_back(first.poses[e]);
    pair.reference.push_back(second.poses[r]);
  }
  return pair;
}

SpatialAlignment alignment_of(const std::string& name) {
  for (const auto& [known, alignment] : spatial_alignment_names()) {
    if (known == name) return alignment;
  }
  return SpatialAlignment::none;
}

void expect_near(double ours, double evos, const std::string& figure) {
  EXPECT_NEAR(ours, evos, 1e-9 * (1.0 + std::abs(evos))) << figure;
}

void expect_absolute(const SpatialPair& pair, const Recorded& recorded) {
  const SpatialAccuracy judged = spatial_accuracy(
      pair.estimate, pair.reference, {pair.plane, pair.plane}, alignment_of(recorded.alignment));
  const auto errors = recorded.error == "heading" ? judged.heading_errors_rad
                      : recorded.error == "position"
                          ? judged.position_errors_m
                          : with_heights(judged.position_errors_m, judged.height_errors_m);
  const auto ours = error_statistics(errors);
  ASSERT_TRUE(ours);
  const std::vector<std::pair<std::string, double>> figures{
      {"rmse", ours->rmse}, {"mean", ours->mean}, {"median", ours->median}, {"std", ours->std},
      {"min", ours->min},   {"max", ours->max},   {"sse", ours->sse}};
  for (std::size_t i = 0; i < figures.size(); ++i) {
    expect_near(figures[i].second, recorded.figures[i], figures[i].first);
  }
  // What the command prints beside them.
  ASSERT_TRUE(judged.accuracy);
  if (recorded.error == "position") {
    expect_near(judged.accuracy->ate_rmse_m, recorded.figures[0], "rmse");
    expect_near(judged.accuracy->mean_position_error_m, recorded.figures[1], "mean");
    expect_near(judged.accuracy->max_position_error_m, recorded.figures[5], "max");
  }
  if (recorded.error == "heading") {
    expect_near(judged.accuracy->heading_rmse_rad, recorded.figures[0], "rmse");
  }
}

void expect_relative(const SpatialPair& pair, const Recorded& recorded) {
  const AssociatedPoses poses = spatial_accuracy(pair.estimate, pair.reference,
                                                 {pair.plane, pair.plane}, SpatialAlignment::none)
                                    .poses;
  const std::size_t step = std::stoul(recorded.alignment.substr(5));
  const auto ours = relative_error(poses.estimate, poses.reference, step);
  ASSERT_TRUE(ours);
  const bool of_heading = recorded.error == "heading";
  expect_near(of_heading ? ours->rotation_rmse_rad : ours->translation_rmse_m, recorded.figures[0],
              "rmse");
  expect_near(of_heading ? ours->rotation_mean_rad : ours->translation_mean_m, recorded.figures[1],
              "mean");
}

void expect_as_recorded(const std::string& name, const SpatialPair& pair, std::size_t cases) {
  const auto all = recorded_of(name);
  ASSERT_EQ(all.size(), cases);
  for (const Recorded& recorded : all) {
    SCOPED_TRACE(name + ' ' + recorded.alignment + ' ' + recorded.error);
    if (recorded.alignment.starts_with("step-")) {
      expect_relative(pair, recorded);
    } else {
      expect_absolute(pair, recorded);
    }
  }
}

TEST(Evo, OnAPlane) {
  expect_as_recorded("flat", pair_of(kFolder / "flat_estimate.tum", kFolder / "flat_reference.tum"),
                     10);
}

TEST(Evo, InSpace) {
  expect_as_recorded("space",
                     pair_of(kFolder / "space_estimate.tum", kFolder / "space_reference.csv"), 9);
}

TEST(Evo, OfACamera) {
  expect_as_recorded("kitti",
                     pair_of(kFolder / "kitti_estimate.txt", kFolder / "kitti_reference.txt"), 3);
}

TEST(Evo, OfRealPictures) {
  FATHOM_REQUIRE_DATA("copr/mav0/odometry0/data.csv");
  const std::filesystem::path mav0 = test::data_path("copr/mav0");
  const std::string content = read_file(mav0 / "odometry0/data.csv");
  std::vector<StampedPose> odometry;
  for (const std::string_view line : split(content, "\n")) {
    if (line.starts_with('#')) continue;
    const auto fields = split_csv(line);
    odometry.push_back({parse_integer(fields[0]).value(),
                        {parse_real(fields[1]).value(), parse_real(fields[2]).value(),
                         parse_real(fields[3]).value()}});
  }
  const test::TemporaryFolder folder;
  write_file(folder / "odometry.tum", to_tum(odometry));
  expect_as_recorded(
      "copr", pair_of(folder / "odometry.tum", mav0 / "state_groundtruth_estimate0/data.csv"), 3);
}

TEST(Evo, OfThreeThousandPoses) {
  FATHOM_REQUIRE_DATA("pose_graphs/M3500.groundtruth.tum");
  const MeasurementLog log = read_g2o(test::data_path("pose_graphs/M3500.g2o"));
  const std::vector<Pose> odometry = log.odometry();
  std::vector<StampedPose> estimate;
  for (std::size_t k = 0; k < odometry.size(); ++k) {
    estimate.push_back({log.ids[k] * 1'000'000'000, odometry[k]});
  }
  const test::TemporaryFolder folder;
  write_file(folder / "M3500.tum", to_tum(estimate));
  expect_as_recorded(
      "M3500", pair_of(folder / "M3500.tum", test::data_path("pose_graphs/M3500.groundtruth.tum")),
      4);
}

}  // namespace
}  // namespace fathom

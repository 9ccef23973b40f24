#include "fathom/geometry/keyframe_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/front_end/candidates.hpp"

namespace fathom {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// A trajectory whose poses move. It says which, or, if not asked to, that it does not know.
class Moving : public TrajectoryView {
 public:
  explicit Moving(bool says_which) : says_which_(says_which) {}

  std::size_t size() const override { return poses_.size(); }
  Pose pose(std::size_t k) const override { return poses_[k]; }
  MovedPoses moved_since(std::uint64_t revision) const override {
    if (!says_which_) return {};
    return {moves_.size(),
            std::vector<std::size_t>(moves_.begin() + static_cast<std::ptrdiff_t>(revision),
                                     moves_.end())};
  }

  void append(const Pose& pose) {
    moves_.push_back(poses_.size());
    poses_.push_back(pose);
  }
  void move(std::size_t k, const Pose& pose) {
    moves_.push_back(k);
    poses_[k] = pose;
  }

 private:
  bool says_which_;
  std::vector<Pose> poses_;
  std::vector<std::size_t> moves_;
};

std::vector<std::size_t> within(const TrajectoryView& trajectory, const Eigen::Vector2d& position,
                                double radius_m) {
  std::vector<std::size_t> near;
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    if ((trajectory.pose(k).position() - position).norm() <= radius_m) near.push_back(k);
  }
  return near;
}

// Every keyframe within the radius, and none that is further than a cell beyond it.
void expect_near(const KeyframeGrid& grid, const TrajectoryView& trajectory,
                 const Eigen::Vector2d& position, double radius_m, double cell_m) {
  const std::vector<std::size_t> found = grid.near(position, radius_m);
  ASSERT_TRUE(std::ranges::is_sorted(found));
  ASSERT_TRUE(std::ranges::adjacent_find(found) == found.end());
  ASSERT_TRUE(std::ranges::includes(found, within(trajectory, position, radius_m)));
  const double furthest_m = std::sqrt(2.0) * (radius_m + 1.001 * cell_m);
  ASSERT_TRUE(std::ranges::includes(within(trajectory, position, furthest_m), found));
}

TEST(KeyframeGrid, FindsWhatIsNearWhileTheTrajectoryGrowsAndMoves) {
  RandomStream random(5, "grid");
  for (const bool says_which : {true, false}) {
    Moving trajectory(says_which);
    KeyframeGrid grid(0.7);
    const auto anywhere = [&] {
      return Pose{8.0 * random.normal(), 8.0 * random.normal(), random.normal()};
    };
    for (int round = 0; round < 60; ++round) {
      for (int j = 0; j < 10; ++j) trajectory.append(anywhere());
      for (int j = 0; j < 15; ++j) {
        trajectory.move(random.index(trajectory.size()), anywhere());
      }
      grid.follow(trajectory);
      for (const double radius_m : {0.0, 0.5, 3.0, 1000.0}) {
        expect_near(grid, trajectory, anywhere().position(), radius_m, 0.7);
        const Pose own = trajectory.pose(random.index(trajectory.size()));
        expect_near(grid, trajectory, own.position(), radius_m, 0.7);
      }
    }
  }
}

// A survey in map coordinates, and poses that left every map.
TEST(KeyframeGrid, KnowsPlacesFarAway) {
  Moving trajectory(true);
  for (const double far_m : {0.0, 4.5e6, -4.5e6, 1e15, -1e15, 1e300}) {
    trajectory.append({far_m, -far_m, 0.0});
    trajectory.append({far_m + 1.0, -far_m, 0.0});
  }
  KeyframeGrid grid(1.0);
  grid.follow(trajectory);
  for (std::size_t k = 0; k < trajectory.size(); ++k) {
    const Eigen::Vector2d position = trajectory.pose(k).position();
    const std::vector<std::size_t> expected = within(trajectory, position, 1.0);
    const std::vector<std::size_t> found = grid.near(position, 1.0);
    EXPECT_TRUE(std::ranges::includes(found, expected)) << k;
  }
  EXPECT_THAT(grid.near({4.5e6, -4.5e6}, 1.0), ElementsAre(2, 3));
}

TEST(KeyframeGrid, AKeyframeWithoutAPlaceIsNearNothing) {
  Moving trajectory(true);
  trajectory.append({0.0, 0.0, 0.0});
  trajectory.append({std::nan(""), 0.0, 0.0});
  trajectory.append({0.0, kInfinity, 0.0});
  KeyframeGrid grid(1.0);
  grid.follow(trajectory);
  EXPECT_THAT(grid.near({0.0, 0.0}, 1e9), ElementsAre(0));
  EXPECT_THAT(grid.near({std::nan(""), 0.0}, 1.0), IsEmpty());
  trajectory.move(1, {0.1, 0.0, 0.0});
  trajectory.move(0, {-kInfinity, 0.0, 0.0});
  grid.follow(trajectory);
  EXPECT_THAT(grid.near({0.0, 0.0}, 1.0), ElementsAre(1));
}

TEST(KeyframeGrid, TakesOverAnotherTrajectory) {
  Moving one(true);
  Moving other(true);
  for (int k = 0; k < 4; ++k) one.append({1.0 * k, 0.0, 0.0});
  for (int k = 0; k < 6; ++k) other.append({0.0, 1.0 * k, 0.0});
  KeyframeGrid grid(0.5);
  grid.follow(one);
  EXPECT_THAT(grid.near({3.0, 0.0}, 0.1), ElementsAre(3));
  grid.follow(other);
  EXPECT_THAT(grid.near({3.0, 0.0}, 0.1), IsEmpty());
  EXPECT_THAT(grid.near({0.0, 5.0}, 0.1), ElementsAre(5));
}

// A search that has followed a trajectory from its start finds what a new one finds, and what a
// test of every keyframe finds.
TEST(CandidateSearch, FindsTheSameAlongAMovingTrajectory) {
  RandomStream random(6, "candidates");
  const Camera camera;
  for (const auto method : {CandidateMethod::distance, CandidateMethod::overlap}) {
    CandidateOptions options;
    options.method = method;
    options.max_distance_m = 1.1;
    options.min_overlap = 0.05;
    CandidateSearch followed(camera, options);
    Moving trajectory(true);
    std::vector<Stance> stances;
    std::size_t found = 0;
    for (std::size_t n = 0; n < 300; ++n) {
      // Legs of 30 keyframes, and an altitude that rises.
      const std::size_t leg = n / 30;
      const double along = static_cast<double>(leg % 2 == 0 ? n % 30 : 29 - n % 30);
      trajectory.append({0.5 * along, 0.8 * static_cast<double>(leg), random.normal()});
      stances.push_back(1.5 + 0.005 * static_cast<double>(n) + 0.3 * random.uniform());
      for (int j = 0; j < 3; ++j) {
        const std::size_t k = random.index(n + 1);
        const Pose pose = trajectory.pose(k);
        trajectory.move(k, {pose.x + 0.2 * random.normal(), pose.y + 0.2 * random.normal(),
                            pose.theta + random.normal()});
      }
      std::vector<std::size_t> expected;
      for (std::size_t k = 0; k < n; ++k) {
        if (followed.accepts(between(trajectory.pose(k), trajectory.pose(n)), stances[k],
                             stances[n])) {
          expected.push_back(k);
        }
      }
      const auto here = followed.find(trajectory, stances, n).keyframes;
      EXPECT_EQ(here, CandidateSearch(camera, options).find(trajectory, stances, n).keyframes);
      EXPECT_EQ(here, expected);
      found += here.size();
    }
    EXPECT_GT(found, 600U);
  }
}

}  // namespace
}  // namespace fathom

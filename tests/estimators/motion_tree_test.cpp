// What leads from one stretch to another where dead reckoning has holes, and H along it.

#include "estimators/trajectory_iekf/motion_tree.hpp"

#include <optional>

#include <gtest/gtest.h>

#include "estimators/trajectory_iekf/stretch.hpp"
#include "fathom/core/random.hpp"
#include "fathom/estimation/stretches.hpp"

namespace fathom {
namespace {

// Stretches 0 to 2, 3 to 5, 6 to 8.
TEST(Stretches, AreATreeOfWhatJoinsThem) {
  Stretches stretches;
  for (std::size_t k = 0; k < 9; ++k) stretches.add_node(k == 3 || k == 6);
  EXPECT_EQ(stretches.open_hole(0, 2), std::nullopt);
  EXPECT_EQ(stretches.open_hole(1, 8), 6U);
  EXPECT_EQ(stretches.open_hole(4, 1), 3U);
  EXPECT_EQ(stretches.held_by(3), (std::vector<bool>{0, 0, 0, 1, 1, 1, 1, 1, 1}));
  stretches.replace(6, 1, 8);
  EXPECT_EQ(stretches.open_hole(1, 8), std::nullopt);
  EXPECT_EQ(stretches.open_hole(4, 8), 3U);
  EXPECT_EQ(stretches.held_by(3), (std::vector<bool>{0, 0, 0, 1, 1, 1, 0, 0, 0}));
  EXPECT_TRUE(stretches.has_open());
  stretches.keep(0, 4);
  EXPECT_EQ(stretches.open_hole(4, 8), std::nullopt);
  EXPECT_FALSE(stretches.has_open());
}

// Motions 2 and 5 lead from keyframe 1 to 8 and from keyframe 8 to 4: the tree turns back twice.
TEST(StretchInATree, JacobianEqualsCentralDifferences) {
  RandomStream random(6, "tree");
  MotionTree tree;
  tree.set(5, {1, 8});
  tree.set(2, {8, 4});
  std::vector<Pose> motions;
  for (int i = 0; i < 9; ++i) {
    motions.push_back({random.uniform(-2, 2), random.uniform(-2, 2), random.uniform(-3, 3)});
  }
  const auto parts = tree.way(3, 9, motions.size());
  ASSERT_EQ(parts.size(), 3U);  // 3 → 4 ← 8 → 9, and motions in order
  EXPECT_EQ(parts[0].begin, 2U);
  EXPECT_EQ(parts[0].sign, -1.0);
  EXPECT_EQ(parts[1].begin, 3U);
  EXPECT_EQ(parts[1].end, 4U);
  EXPECT_EQ(parts[2].begin, 8U);
  for (const std::size_t from : {0, 2, 3, 5, 6, 8}) {
    const std::size_t first = tree.way(from, 9, motions.size()).front().begin;
    const Stretch stretch(tree, first, motions);
    const Eigen::Matrix3Xd H = stretch.H(from);
    const std::vector<StackedJacobian::Rows> rows{{from}};
    const StackedJacobian stacked(stretch, rows);
    ASSERT_EQ(static_cast<std::size_t>(stacked.starts().front()), first);
    EXPECT_LT((stacked.times(Eigen::MatrixXd::Identity(H.cols(), H.cols())) - H).norm(), 1e-12);
    const Eigen::Vector3d lambda(0.3, -0.2, 0.7);
    EXPECT_LT((stacked.transposed_times(lambda) - H.transpose() * lambda).norm(), 1e-12);
    for (Eigen::Index column = 0; column < H.cols(); ++column) {
      const double step = 1e-6;
      const auto moved = [&](double by) {
        std::vector<Pose> at = motions;
        Pose& motion = at[first + static_cast<std::size_t>(column / 3)];
        Eigen::Vector3d v = motion.vector();
        v(column % 3) += by;
        motion = Pose::from_vector(v);
        return Stretch(tree, first, at).h(from).vector();
      };
      Eigen::Vector3d difference = moved(step) - moved(-step);
      difference.z() = wrap_angle(difference.z());
      EXPECT_LT((H.col(column) - difference / (2 * step)).norm(), 1e-7) << from << " " << column;
    }
  }
}

}  // namespace
}  // namespace fathom

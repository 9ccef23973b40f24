#include "fathom/estimation/filter_covariance.hpp"

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace fathom {
namespace {

// A state of several blocks with a full covariance, and the same as a plain matrix.
struct Both {
  FilterCovariance ours;
  Eigen::MatrixXd plain;

  explicit Both(Eigen::Index blocks) {
    const Eigen::Index n = 3 * blocks;
    srand(7);
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
    plain = A * A.transpose() + Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index k = 0; k < blocks; ++k) {
      ours.append(plain.block(3 * k, 0, 3, 3 * k), plain.block<3, 3>(3 * k, 3 * k));
    }
  }
};

TEST(FilterCovariance, KeepsWhatWasAppendedWhileItGrows) {
  for (const Eigen::Index blocks : {1, 2, 31, 32, 33, 100}) {
    const Both both(blocks);
    EXPECT_EQ(both.ours.size(), 3 * blocks);
    EXPECT_LT((both.ours.full() - both.plain).norm(), 1e-12 * both.plain.norm());
    for (const Eigen::Index k : {Eigen::Index{0}, blocks / 2, blocks - 1}) {
      EXPECT_LT((both.ours.column(k) - both.plain.middleCols<3>(3 * k)).norm(),
                1e-12 * both.plain.norm());
      EXPECT_LT((both.ours.block(k, 0) - both.plain.block<3, 3>(3 * k, 0)).norm(), 1e-9);
      EXPECT_LT((both.ours.block(0, k) - both.plain.block<3, 3>(0, 3 * k)).norm(), 1e-9);
    }
  }
}

TEST(FilterCovariance, AppendingWithoutCrossCovarianceLeavesItZero) {
  FilterCovariance P;
  P.append(Eigen::Matrix3d::Identity());
  P.append(2.0 * Eigen::Matrix3d::Identity());
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
  expected.diagonal() << 1, 1, 1, 2, 2, 2;
  EXPECT_EQ(P.full(), expected);
}

TEST(FilterCovariance, MultipliesByAMatrixThatIsZeroAboveABlock) {
  for (const Eigen::Index blocks : {1, 7, 12, 50}) {
    const Both both(blocks);
    for (const Eigen::Index first : {Eigen::Index{0}, blocks / 3, blocks - 1}) {
      const Eigen::MatrixXd B = Eigen::MatrixXd::Random(3 * (blocks - first), 6);
      Eigen::MatrixXd padded = Eigen::MatrixXd::Zero(3 * blocks, 6);
      padded.bottomRows(B.rows()) = B;
      const Eigen::MatrixXd expected = both.plain * padded;
      EXPECT_LT((both.ours.times(first, B) - expected).norm(), 1e-11 * expected.norm());
      EXPECT_LT((both.ours.tail_times(first, B) - expected.bottomRows(B.rows())).norm(),
                1e-11 * expected.norm());
    }
  }
}

TEST(FilterCovariance, DowndatesAsTheKalmanUpdateDoes) {
  Both both(20);
  const Eigen::MatrixXd H = Eigen::MatrixXd::Random(6, 60);
  const Eigen::MatrixXd S = H * both.plain * H.transpose() + 0.1 * Eigen::MatrixXd::Identity(6, 6);
  const Eigen::MatrixXd expected =
      both.plain - both.plain * H.transpose() * S.inverse() * H * both.plain;
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  both.ours.downdate(llt.matrixL().solve(H * both.plain));
  EXPECT_LT((both.ours.full() - expected).norm(), 1e-10 * both.plain.norm());
  EXPECT_EQ(both.ours.full(), both.ours.full().transpose());
}

}  // namespace
}  // namespace fathom

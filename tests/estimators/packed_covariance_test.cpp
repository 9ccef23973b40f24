#include "estimators/support/filter/packed_covariance.hpp"

#include <algorithm>
#include <array>
#include <vector>

#include <Eigen/Dense>
#include <gtest/gtest.h>

namespace fathom {
namespace {

// A state of several blocks with a full covariance, and the same as a plain matrix.
struct PackedAndDense {
  filter::PackedCovariance ours;
  Eigen::MatrixXd plain;

  explicit PackedAndDense(Eigen::Index blocks) {
    const Eigen::Index n = 3 * blocks;
    srand(7);
    const Eigen::MatrixXd A = Eigen::MatrixXd::Random(n, n);
    plain = A * A.transpose() + Eigen::MatrixXd::Identity(n, n);
    for (Eigen::Index k = 0; k < blocks; ++k) {
      ours.append(plain.block(3 * k, 0, 3, 3 * k), plain.block<3, 3>(3 * k, 3 * k));
    }
  }
};

TEST(PackedCovariance, KeepsWhatWasAppendedWhileItGrows) {
  for (const Eigen::Index blocks : {1, 2, 31, 32, 33, 100}) {
    const PackedAndDense both(blocks);
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

TEST(PackedCovariance, DowndatesButForWhatIsKept) {
  for (const Eigen::Index blocks : {2, 8, 9, 30}) {
    Eigen::MatrixXd plain = PackedAndDense(blocks).plain;
    std::vector<Eigen::Index> kept;
    for (Eigen::Index k = 1; k < blocks; k += k % 3 == 0 ? 1 : 2) kept.push_back(k);
    filter::PackedCovariance ours;
    for (Eigen::Index k = 0; k < blocks; ++k) {
      for (const Eigen::Index i : kept) {
        const bool is_kept = std::find(kept.begin(), kept.end(), k) != kept.end();
        if (is_kept && i != k) plain.block<3, 3>(3 * k, 3 * i).setZero();
      }
      ours.append(plain.block(3 * k, 0, 3, 3 * k), plain.block<3, 3>(3 * k, 3 * k));
    }
    const Eigen::MatrixXd V = Eigen::MatrixXd::Random(3 * blocks, 5);
    Eigen::MatrixXd expected = plain - V * V.transpose();
    for (const Eigen::Index i : kept) {
      for (const Eigen::Index j : kept) {
        expected.block<3, 3>(3 * i, 3 * j) = plain.block<3, 3>(3 * i, 3 * j);
      }
    }
    ours.downdate_but(kept, V);
    EXPECT_LT((ours.full() - expected).norm(), 1e-12 * expected.norm()) << blocks;
    for (const Eigen::Index i : kept) {
      EXPECT_EQ(ours.block(i, i), Eigen::Matrix3d(plain.block<3, 3>(3 * i, 3 * i)));
      EXPECT_TRUE(i == kept.front() || ours.block(i, kept.front()).isZero(0.0));
    }
  }
}

TEST(PackedCovariance, AppendingWithoutCrossCovarianceLeavesItZero) {
  filter::PackedCovariance P;
  P.append(Eigen::Matrix3d::Identity());
  P.append(2.0 * Eigen::Matrix3d::Identity());
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(6, 6);
  expected.diagonal() << 1, 1, 1, 2, 2, 2;
  EXPECT_EQ(P.full(), expected);
}

// Zero above a block.
Eigen::MatrixXd from_block(Eigen::Index block, Eigen::Index first, const Eigen::MatrixX3d& B,
                           Eigen::Index size) {
  Eigen::MatrixXd end = Eigen::MatrixXd::Zero(size, 3);
  end.bottomRows(size - 3 * block) = B.bottomRows(B.rows() - 3 * (block - first));
  return end;
}

TEST(PackedCovariance, MultipliesByTheEndsOfAMatrixInOnePass) {
  for (const Eigen::Index blocks : {1, 7, 8, 9, 17, 50}) {
    const PackedAndDense both(blocks);
    const Eigen::Index n = 3 * blocks;
    for (const Eigen::Index first : {Eigen::Index{0}, blocks / 3, blocks - 1}) {
      std::vector<Eigen::Index> starts{first};
      for (const Eigen::Index start : {first + 1, first + 2, blocks / 2, blocks - 1}) {
        if (start > starts.back() && start < blocks) starts.push_back(start);
      }
      const Eigen::MatrixX3d B = Eigen::MatrixXd::Random(n - 3 * first, 3);
      const auto columns = static_cast<Eigen::Index>(3 * starts.size());
      Eigen::MatrixXd ours(B.rows(), columns);
      Eigen::MatrixXd two = Eigen::MatrixXd::Constant(B.rows(), columns, 7.0);
      Eigen::MatrixXd head(3 * first, columns);
      both.ours.suffix_products(starts, B, ours);
      both.ours.suffix_products(starts, B, two, 2);
      both.ours.head_products(starts, B, head);
      for (std::size_t s = 0; s < starts.size(); ++s) {
        const Eigen::MatrixXd expected = both.plain * from_block(starts[s], first, B, n);
        const auto column = static_cast<Eigen::Index>(3 * s);
        const double small = 1e-12 * expected.norm();
        EXPECT_LT((ours.middleCols<3>(column) - expected.bottomRows(B.rows())).norm(), small);
        EXPECT_LT((two.middleCols<2>(column) - expected.bottomRows(B.rows()).leftCols<2>()).norm(),
                  small);
        EXPECT_EQ(two.col(column + 2), Eigen::VectorXd::Constant(B.rows(), 7.0));
        EXPECT_LE((head.middleCols<3>(column) - expected.topRows(3 * first)).norm(), small);
      }
    }
  }
}

TEST(PackedCovariance, SumsBothSidesOfTheDiagonal) {
  for (const Eigen::Index blocks : {1, 8, 9, 21}) {
    const PackedAndDense both(blocks);
    const Eigen::MatrixX3d B = Eigen::MatrixXd::Random(3 * blocks, 3);
    const filter::PackedCovariance::Sides sides = both.ours.side_products(B);
    for (Eigen::Index k = 0; k < blocks; ++k) {
      const Eigen::Matrix3Xd row = both.plain.middleRows<3>(3 * k);
      const Eigen::Index after = 3 * (blocks - k - 1);
      const Eigen::Matrix3d before_k = row.leftCols(3 * k) * B.topRows(3 * k);
      const Eigen::Matrix3d after_k = row.rightCols(after) * B.bottomRows(after);
      EXPECT_LE((sides.before.middleRows<3>(3 * k) - before_k).norm(), 1e-12 * row.norm());
      EXPECT_LE((sides.after.middleRows<3>(3 * k) - after_k).norm(), 1e-12 * row.norm());
    }
  }
}

TEST(PackedCovariance, DowndatesAsTheKalmanUpdateDoes) {
  PackedAndDense both(20);
  const Eigen::MatrixXd H = Eigen::MatrixXd::Random(6, 60);
  const Eigen::MatrixXd S = H * both.plain * H.transpose() + 0.1 * Eigen::MatrixXd::Identity(6, 6);
  const Eigen::MatrixXd expected =
      both.plain - both.plain * H.transpose() * S.inverse() * H * both.plain;
  const Eigen::LLT<Eigen::MatrixXd> llt(S);
  both.ours.downdate(Eigen::MatrixXd(llt.matrixL().solve(H * both.plain).transpose()));
  EXPECT_LT((both.ours.full() - expected).norm(), 1e-10 * both.plain.norm());
  EXPECT_EQ(both.ours.full(), both.ours.full().transpose());
}

TEST(PackedCovariance, DowndatesByFactorsThatCoverPartOfTheState) {
  PackedAndDense both(30);
  std::vector<filter::DowndateFactor> factors;
  for (const auto& [first, rows, rank] : {std::array{0, 90, 3}, std::array{30, 27, 6},
                                          std::array{72, 18, 3}, std::array{21, 48, 9}}) {
    factors.push_back({first, 0.1 * Eigen::MatrixXd::Random(rows, rank)});
    both.plain.block(first, first, rows, rows) -= factors.back().V * factors.back().V.transpose();
  }
  both.ours.downdate(factors);
  EXPECT_LT((both.ours.full() - both.plain).norm(), 1e-13 * both.plain.norm());
  EXPECT_EQ(both.ours.full(), both.ours.full().transpose());
}

// Half of the square, and an eighth of that in store for what is to come, in pages of 2 MiB.
TEST(PackedCovariance, HoldsATriangle) {
  filter::PackedCovariance P;
  for (int k = 0; k < 800; ++k) P.append(Eigen::Matrix3d::Identity());
  const double triangle = 0.5 * 2400 * 2400 * sizeof(double);
  EXPECT_GT(static_cast<double>(P.bytes()), triangle);
  EXPECT_LT(static_cast<double>(P.bytes()), 1.15 * triangle + 2 * 1024 * 1024);
}

}  // namespace
}  // namespace fathom

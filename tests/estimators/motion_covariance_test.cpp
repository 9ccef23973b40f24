// The covariance of the stacked motions in its two forms, and the structure of H, against products
// that are multiplied out.

#include "estimators/trajectory_iekf/motion_covariance.hpp"

#include <array>
#include <cmath>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "estimators/trajectory_iekf/stretch.hpp"
#include "fathom/core/random.hpp"

namespace fathom {
namespace {

using CovarianceForm = MotionCovariance::Form;

constexpr std::array kForms{CovarianceForm::dense, CovarianceForm::few_loops,
                            CovarianceForm::cheapest};

Eigen::MatrixXd random(Eigen::Index rows, Eigen::Index columns, RandomStream& stream) {
  Eigen::MatrixXd matrix(rows, columns);
  for (double& number : matrix.reshaped()) number = stream.normal();
  return matrix;
}

// Keyframes come and updates happen between them, from one motion up to all; and the same as a
// plain matrix.
struct Both {
  MotionCovariance ours;
  Eigen::MatrixXd plain;

  explicit Both(CovarianceForm form, Eigen::Index motions = 40) : ours(form) {
    RandomStream stream(3, "updates");
    for (Eigen::Index n = 1; n <= motions; ++n) {
      Eigen::MatrixXd grown = Eigen::MatrixXd::Zero(3 * n, 3 * n);
      grown.topLeftCorner(3 * n - 3, 3 * n - 3) = plain;
      const Eigen::MatrixXd A = random(3, 3, stream);
      const Eigen::Matrix3d Q = A * A.transpose() + Eigen::Matrix3d::Identity();
      grown.bottomRightCorner<3, 3>() = Q;
      plain = grown;
      ours.append(Q);
      if (n % 6 == 0) update(n / 3, 6, stream);
      // Cheaper folded, in the cheapest form; what comes later is cheaper as factors.
      if (n == 13) update(0, 30, stream);
      if (n == 33) update(2, 3, stream);
    }
  }

  void update(Eigen::Index first, Eigen::Index rank, RandomStream& stream) {
    const Eigen::MatrixXd V = 0.1 * random(plain.rows() - 3 * first, rank, stream);
    plain.bottomRightCorner(V.rows(), V.rows()) -= V * V.transpose();
    ours.downdate(V);
  }
};

TEST(MotionCovariance, IsTheSameMatrixInEveryForm) {
  for (const CovarianceForm form : kForms) {
    const Both both(form);
    EXPECT_LT((both.ours.full() - both.plain).norm(), 1e-13 * both.plain.norm());
  }
  EXPECT_EQ(Both(CovarianceForm::few_loops).ours.dense_motions(), 0);
  EXPECT_GE(Both(CovarianceForm::dense).ours.dense_motions(), 36);
  // Dense and factors at a time, which the products below must hold for, too.
  EXPECT_EQ(Both(CovarianceForm::cheapest).ours.dense_motions(), 13);
}

// Dense motions, and later ones.
TEST(MotionCovariance, ReplacesAMotionAndGivesColumns) {
  for (const CovarianceForm form : kForms) {
    for (const Eigen::Index i : {0, 10, 31, 32, 33, 39}) {
      Both both(form);
      const Eigen::MatrixX3d column = both.plain.middleCols<3>(3 * i);
      EXPECT_LT((both.ours.column(i) - column).norm(), 1e-12 * column.norm());
      const Eigen::Matrix3d Q = Eigen::Vector3d(2.0, 3.0, 4.0).asDiagonal();
      both.plain.middleCols<3>(3 * i).setZero();
      both.plain.middleRows<3>(3 * i).setZero();
      both.plain.block<3, 3>(3 * i, 3 * i) = Q;
      both.ours.replace(i, Q);
      EXPECT_LT((both.ours.full() - both.plain).norm(), 1e-12 * both.plain.norm());
      RandomStream stream(9, "after");
      both.update(0, 3, stream);
      EXPECT_LT((both.ours.full() - both.plain).norm(), 1e-12 * both.plain.norm());
    }
  }
}

TEST(MotionCovariance, MultipliesByTheEndsOfAMatrixInEveryForm) {
  RandomStream stream(4, "right-hand side");
  for (const CovarianceForm form : kForms) {
    const Both both(form);
    for (const std::vector<Eigen::Index>& starts :
         {std::vector<Eigen::Index>{0, 7, 38}, {5}, {33, 34, 39}, {39}, {3, 12, 13, 14, 30}}) {
      const Eigen::Index rows = both.plain.rows() - 3 * starts.front();
      const Eigen::MatrixX3d B = random(rows, 3, stream);
      Eigen::MatrixX3d other = random(rows, 3, stream);
      other.col(2) = B.col(2);
      Eigen::MatrixXd product(rows, static_cast<Eigen::Index>(3 * starts.size()));
      both.ours.suffix_products(starts, B, product);
      Eigen::MatrixXd again = product;
      both.ours.suffix_products(starts, other, again, 2);
      const Eigen::MatrixXd head = both.ours.head_products(starts, B);
      const Eigen::Index begin = both.ours.first_correlated(starts.front());
      for (std::size_t s = 0; s < starts.size(); ++s) {
        const auto column = static_cast<Eigen::Index>(3 * s);
        const Eigen::Index end = both.plain.rows() - 3 * starts[s];
        const auto P = both.plain.rightCols(end);
        const Eigen::MatrixXd expected = P * B.bottomRows(end);
        const Eigen::MatrixXd expected_again = P * other.bottomRows(end);
        const double small = 1e-12 * (1.0 + expected.norm());
        EXPECT_LT((product.middleCols<3>(column) - expected.bottomRows(rows)).norm(), small);
        EXPECT_LT((again.middleCols<3>(column) - expected_again.bottomRows(rows)).norm(), small);
        const Eigen::Index above = 3 * starts.front();
        EXPECT_LT(
            (head.middleCols<3>(column) - expected.middleRows(3 * begin, above - 3 * begin)).norm(),
            small);
        EXPECT_TRUE(expected.topRows(3 * begin).isZero(0.0));
      }
    }
  }
}

TEST(MotionCovariance, TransformsEveryStretchFromEitherEnd) {
  RandomStream stream(5, "jacobian");
  for (const CovarianceForm form : kForms) {
    const Both both(form);
    const Eigen::MatrixX3d B = random(both.plain.rows(), 3, stream);
    const auto up = both.ours.congruences(B, MotionCovariance::Over::motions_up_to);
    const auto from = both.ours.congruences(B, MotionCovariance::Over::motions_from);
    for (Eigen::Index k = 0; 3 * k < B.rows(); ++k) {
      const Eigen::Index head = 3 * (k + 1);
      const Eigen::Index tail = B.rows() - 3 * k;
      const Eigen::Matrix3d of_head =
          B.topRows(head).transpose() * both.plain.topLeftCorner(head, head) * B.topRows(head);
      const Eigen::Matrix3d of_tail = B.bottomRows(tail).transpose() *
                                      both.plain.bottomRightCorner(tail, tail) * B.bottomRows(tail);
      const auto index = static_cast<std::size_t>(k);
      EXPECT_LT((up[index] - of_head).norm(), 1e-12 * of_head.norm());
      EXPECT_LT((from[index] - of_tail).norm(), 1e-12 * of_tail.norm());
    }
  }
}

// Few loops are kept as they are; as many loops as motions are not.
TEST(MotionCovariance, TakesTheCheaperForm) {
  for (const bool many : {false, true}) {
    RandomStream stream(6, "loops");
    MotionCovariance P;
    for (Eigen::Index n = 1; n <= 300; ++n) {
      P.append(Eigen::Matrix3d::Identity());
      if (many || n % 20 == 0) P.downdate(0.01 * random(3 * n, 3, stream));
    }
    EXPECT_EQ(P.dense_motions(), many ? 300 : 0);
    const double triangle = 0.5 * 900 * 900 * sizeof(double);
    const double most = many ? 1.15 * triangle + 2 * 1024 * 1024 : 0.15 * triangle;
    EXPECT_LT(static_cast<double>(P.bytes()), most);
  }
}

// 10 000 motions, 30 loops: the whole matrix would take 7.2 GB.
TEST(MotionCovariance, OfALongMissionTakesMemoryByItsLoops) {
  constexpr Eigen::Index kMotions = 10000;
  MotionCovariance P;
  for (Eigen::Index n = 1; n <= kMotions; ++n) {
    P.append(Eigen::Matrix3d::Identity());
    if (n % 1000 == 0) P.downdate(Eigen::MatrixXd::Constant(3 * n, 9, 1e-3));
  }
  // 9 numbers for each row of a state that is half as long in the mean, ten times; and the Q.
  const double expected = 10 * 9 * 0.55 * 3 * kMotions * sizeof(double) + 72.0 * kMotions;
  EXPECT_GT(static_cast<double>(P.bytes()), 0.9 * expected);
  EXPECT_LT(static_cast<double>(P.bytes()), 1.2 * expected);
}

// Headings around ±π; registrations in no order, two from the same keyframe.
TEST(StackedJacobian, ProductsAreThoseOfHMultipliedOut) {
  RandomStream stream(7, "stretch");
  const std::size_t first = 4;
  const std::size_t length = 25;
  std::vector<Pose> motions;
  for (std::size_t i = 0; i < length; ++i) {
    motions.push_back({stream.uniform(-2, 2), stream.uniform(-2, 2),
                       wrap_angle(M_PI + stream.uniform(-0.3, 0.3))});
  }
  const Stretch stretch(first, motions);
  const std::vector<std::size_t> froms{first + 9, first, first + 24, first + 9};
  std::vector<StackedJacobian::Rows> rows;
  for (const std::size_t from : froms) rows.push_back({from});
  const StackedJacobian H(stretch, rows);
  Eigen::MatrixXd naive(3 * froms.size(), 3 * length);
  for (std::size_t j = 0; j < froms.size(); ++j) {
    naive.middleRows<3>(static_cast<Eigen::Index>(3 * j)) = stretch.H(froms[j]);
  }
  const Eigen::MatrixXd X = random(naive.cols(), 5, stream);
  EXPECT_LT((H.times(X) - naive * X).norm(), 1e-12 * X.norm());
  const Eigen::VectorXd lambda = random(naive.rows(), 1, stream);
  EXPECT_LT((H.transposed_times(lambda) - naive.transpose() * lambda).norm(), 1e-12 * naive.norm());

  for (const CovarianceForm form : kForms) {
    const Both both(form, static_cast<Eigen::Index>(first + length));
    Eigen::MatrixXd sums(naive.cols(), static_cast<Eigen::Index>(3 * H.starts().size()));
    both.ours.suffix_products(H.starts(), H.A_transposed(), sums);
    const Eigen::MatrixXd expected =
        both.plain.bottomRightCorner(naive.cols(), naive.cols()) * naive.transpose();
    EXPECT_LT((sums * H.ends() - expected).norm(), 1e-12 * expected.norm());
  }
}

}  // namespace
}  // namespace fathom

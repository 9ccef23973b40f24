#include <cmath>

#include <Eigen/Eigenvalues>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "fathom/geometry/covariance.hpp"

namespace fathom {
namespace {

// The quick answer and the eigenvalues agree wherever the one is given.
TEST(Definiteness, IsWhatTheEigenvaluesSay) {
  RandomStream random(4, "definite");
  int definite = 0;
  for (int i = 0; i < 20000; ++i) {
    Eigen::Matrix3d A = Eigen::Matrix3d::NullaryExpr([&] { return random.normal(); });
    // Nearly singular ones, indefinite ones, and units that differ.
    if (i % 3 == 0) A.col(2) = A.col(0) + std::pow(10.0, -random.uniform(0, 9)) * A.col(1);
    Eigen::Matrix3d M = A * A.transpose();
    if (i % 5 == 0) M -= random.uniform(0, 1) * Eigen::Matrix3d::Identity();
    const Eigen::Vector3d unit(std::pow(10.0, random.uniform(-6, 6)), 1.0, 1e-4);
    M = unit.asDiagonal() * M * unit.asDiagonal();
    M = (0.5 * (M + M.transpose())).eval();
    bool expected = (M.diagonal().array() > 0.0).all();
    if (expected) {
      const Eigen::Vector3d s = M.diagonal().cwiseSqrt().cwiseInverse();
      const Eigen::Matrix3d scaled = s.asDiagonal() * M * s.asDiagonal();
      const double least = scaled.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff();
      if (std::abs(least - 1e-12) < 1e-14) continue;
      expected = least > 1e-12;
    }
    EXPECT_EQ(is_positive_definite(M), expected) << M;
    definite += expected ? 1 : 0;
  }
  EXPECT_GT(definite, 8000);
  EXPECT_LT(definite, 19900);
}

TEST(InformationRows, MultiplyToTheInformation) {
  RandomStream random(4, "rows");
  for (int rank = 0; rank <= 3; ++rank) {
    for (int i = 0; i < 50; ++i) {
      Eigen::Matrix3d M = Eigen::Matrix3d::Zero();
      for (int r = 0; r < rank; ++r) {
        const Eigen::Vector3d v(random.normal(), random.normal(), 1e3 * random.normal());
        M += v * v.transpose();
      }
      EXPECT_TRUE(is_positive_semidefinite(M));
      const InformationRows measured = rows_of(M);
      EXPECT_EQ(measured.rank, rank);
      const Eigen::Matrix3d again = measured.rows.transpose() *
                                    measured.variances.cwiseInverse().asDiagonal() * measured.rows;
      EXPECT_LT((again - M).norm(), 1e-12 * M.norm() + 1e-300);
    }
  }
  const InformationRows heading = rows_of(Eigen::Vector3d(0.0, 0.0, 25.0).asDiagonal());
  EXPECT_EQ(heading.rank, 1);
  EXPECT_NEAR(std::abs(heading.rows(0, 2)) / std::sqrt(heading.variances(0)), 5.0, 1e-14);
  EXPECT_FALSE(is_positive_semidefinite(Eigen::Vector3d(1.0, -1e-3, 1.0).asDiagonal()));
  Eigen::Matrix3d no_diagonal = Eigen::Matrix3d::Identity();
  no_diagonal(2, 2) = 0.0;
  no_diagonal(0, 2) = no_diagonal(2, 0) = 0.1;
  EXPECT_FALSE(is_positive_semidefinite(no_diagonal));
}

}  // namespace
}  // namespace fathom

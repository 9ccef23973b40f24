#include "estimators/ceres_pose_graph/edge_cost.hpp"

#include <array>
#include <cmath>

#include <Eigen/Eigenvalues>
#include <ceres/autodiff_cost_function.h>
#include <gtest/gtest.h>

#include "fathom/core/random.hpp"
#include "tests/estimators/logs.hpp"

namespace fathom {
namespace {

// The residual written a second time, for automatic differentiation: t2v(Z⁻¹ · A⁻¹ · B), weighted
// by a square root of Ω that is found in another way than by Cholesky.
struct AutodiffEdge {
  Pose z;
  Eigen::Matrix3d root;  // rootᵀ root = Ω

  template <class T>
  bool operator()(const T* a, const T* b, T* r) const {
    using std::cos;
    using std::sin;
    const T dx = b[0] - a[0];
    const T dy = b[1] - a[1];
    const T px = cos(a[2]) * dx + sin(a[2]) * dy - z.x;
    const T py = -sin(a[2]) * dx + cos(a[2]) * dy - z.y;
    const double c = cos(z.theta);
    const double s = sin(z.theta);
    const T turn = b[2] - a[2] - z.theta;
    Eigen::Matrix<T, 3, 1> e;
    e << c * px + s * py, -s * px + c * py, atan2(sin(turn), cos(turn));
    Eigen::Map<Eigen::Matrix<T, 3, 1>> out(r);
    out = root.cast<T>() * e;
    return true;
  }
};

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

struct LinearisedCost {
  Eigen::Vector3d r;
  RowMajor3 J_a;
  RowMajor3 J_b;
};

LinearisedCost evaluate(const ceres::CostFunction& cost, const Pose& a, const Pose& b) {
  LinearisedCost result;
  const Eigen::Vector3d va = a.vector();
  const Eigen::Vector3d vb = b.vector();
  const std::array<const double*, 2> parameters{va.data(), vb.data()};
  std::array<double*, 2> jacobians{result.J_a.data(), result.J_b.data()};
  EXPECT_TRUE(cost.Evaluate(parameters.data(), result.r.data(), jacobians.data()));
  return result;
}

// Whitening with L in place of Lᵀ would pass with a diagonal Ω; here it is full. r and r' may
// differ by a rotation, so what must agree is rᵀr, Jᵀr and JᵀJ.
TEST(EdgeCost, EqualsAutomaticDifferentiationWithFullInformation) {
  RandomStream random(3, "edge");
  for (int i = 0; i < 200; ++i) {
    const auto pose = [&] {
      const double range = i % 3 == 0 ? 1e-9 : 5.0;
      const double around = i % 2 == 0 ? M_PI : 0.0;
      return Pose{random.uniform(-range, range), random.uniform(-range, range),
                  wrap_angle(around + random.uniform(-0.3, 0.3))};
    };
    const Pose a = pose();
    const Pose b = pose();
    const RelativePose z =
        RelativePose::from_covariance(0, 1, pose(), test::full_covariance(0.2, 0.1));
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> eigen(z.information);
    const ceres::AutoDiffCostFunction<AutodiffEdge, 3, 3, 3> reference(
        new AutodiffEdge{z.motion, eigen.operatorSqrt()});
    const LinearisedCost ours = evaluate(EdgeCost(z), a, b);
    const LinearisedCost other = evaluate(reference, a, b);
    const double scale = 1.0 + other.r.squaredNorm();
    EXPECT_NEAR(ours.r.squaredNorm(), other.r.squaredNorm(), 1e-11 * scale);
    EXPECT_NEAR(ours.r.squaredNorm(), chi2(z, a, b), 1e-11 * scale);
    EXPECT_LT((ours.J_a.transpose() * ours.r - other.J_a.transpose() * other.r).norm(),
              1e-10 * (1.0 + (other.J_a.transpose() * other.r).norm()));
    EXPECT_LT((ours.J_b.transpose() * ours.r - other.J_b.transpose() * other.r).norm(),
              1e-10 * (1.0 + (other.J_b.transpose() * other.r).norm()));
    EXPECT_LT((ours.J_a.transpose() * ours.J_b - other.J_a.transpose() * other.J_b).norm(),
              1e-10 * (other.J_a.transpose() * other.J_b).norm());
  }
}

TEST(EdgeCost, GivesTheResidualAloneWhenAsked) {
  const RelativePose z =
      RelativePose::from_covariance(0, 1, {1.0, 0.0, 0.1}, test::full_covariance(0.2, 0.1));
  const Eigen::Vector3d a = Eigen::Vector3d::Zero();
  const Eigen::Vector3d b(1.0, 0.0, 0.1);
  const std::array<const double*, 2> parameters{a.data(), b.data()};
  Eigen::Vector3d r;
  EXPECT_TRUE(EdgeCost(z).Evaluate(parameters.data(), r.data(), nullptr));
  EXPECT_LT(r.norm(), 1e-12);
  RowMajor3 J_b;
  std::array<double*, 2> jacobians{nullptr, J_b.data()};
  EXPECT_TRUE(EdgeCost(z).Evaluate(parameters.data(), r.data(), jacobians.data()));
  EXPECT_GT(J_b.norm(), 1.0);
}

}  // namespace
}  // namespace fathom

// Logs whose information spans up to 21 decades: every graph back end against least squares in
// extended precision.

#include <cmath>
#include <numbers>
#include <ostream>

#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <gtest/gtest.h>

#include "estimators/support/pose_graph/picture_states.hpp"
#include "fathom/core/random.hpp"
#include "fathom/estimation/precision.hpp"
#include "tests/estimators/graph_parts.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/measurements/shared_log.hpp"

namespace fathom {
namespace {

using Real = long double;
using RealMatrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;
using RealVector = Eigen::Matrix<Real, Eigen::Dynamic, 1>;
using Real3 = Eigen::Matrix<Real, 3, 3>;

// The optimum and its covariance.
class ExtendedLeastSquares {
 public:
  ExtendedLeastSquares(const MeasurementLog& log, const std::vector<Pose>& start) : log_(log) {
    for (const Pose& pose : start) x_.insert(x_.end(), {pose.x, pose.y, pose.theta});
    for (int i = 0; i < 20; ++i) step();
  }

  double cost() const { return static_cast<double>(cost_); }
  Eigen::Matrix3d covariance(std::size_t k) const {
    const auto row = static_cast<Eigen::Index>(3 * (k - 1));
    return covariance_.block(row, row, 3, 3).cast<double>();
  }

 private:
  void step() {
    const auto columns = static_cast<Eigen::Index>(x_.size());
    J_ = RealMatrix::Zero(0, columns + 1);
    for (std::size_t k = 1; k < log_.size(); ++k) {
      add(log_.arrival(k).step);
      for (const RelativePose& z : log_.arrival(k).registrations) add(z);
    }
    cost_ = J_.rightCols(1).squaredNorm();
    const RealMatrix J = J_.middleCols(3, columns - 3);
    const Eigen::HouseholderQR<RealMatrix> qr(J);
    const RealVector dx = qr.solve(J_.rightCols(1));
    for (Eigen::Index i = 0; i < dx.size(); ++i) x_[static_cast<std::size_t>(i) + 3] -= dx(i);
    RealMatrix inverse = RealMatrix::Identity(columns - 3, columns - 3);
    qr.matrixQR().topRows(columns - 3).triangularView<Eigen::Upper>().solveInPlace(inverse);
    covariance_ = inverse * inverse.transpose();
  }

  // Whitened: Lᵀ e and its derivatives, e = Dᵀ (h − z).
  void add(const RelativePose& z) {
    const Real* i = x_.data() + 3 * z.from;
    const Real* k = x_.data() + 3 * z.to;
    const auto turn = [](Real angle) {
      Real3 R = Real3::Identity();
      R.topLeftCorner<2, 2>() << std::cos(angle), std::sin(angle), -std::sin(angle),
          std::cos(angle);
      return R;
    };
    const Real3 U = Real3(z.information.cast<Real>().llt().matrixU()) * turn(z.motion.theta);
    const Real3 P = turn(i[2]);
    Real3 T = Real3::Identity();
    T.topRightCorner<2, 1>() << -(k[1] - i[1]), k[0] - i[0];
    Eigen::Matrix<Real, 3, 1> nu = P * Eigen::Matrix<Real, 3, 1>(k[0] - i[0], k[1] - i[1], 0.0L) -
                                   Eigen::Matrix<Real, 3, 1>(z.motion.x, z.motion.y, 0.0L);
    nu(2) = std::remainder(k[2] - i[2] - static_cast<Real>(z.motion.theta),
                           2.0L * std::numbers::pi_v<Real>);
    const Eigen::Index row = J_.rows();
    J_.conservativeResize(row + 3, Eigen::NoChange);
    J_.bottomRows(3).setZero();
    J_.block<3, 3>(row, static_cast<Eigen::Index>(3 * z.from)) = -U * P * T;
    J_.block<3, 3>(row, static_cast<Eigen::Index>(3 * z.to)) = U * P;
    J_.block<3, 1>(row, J_.cols() - 1) = U * nu;
  }

  const MeasurementLog& log_;
  std::vector<Real> x_;
  RealMatrix J_;  ///< and the residuals
  Real cost_ = 0.0L;
  RealMatrix covariance_;
};

struct Scales {
  std::string name;
  Eigen::Vector3d steps;  ///< information of (x, y, θ)
  Eigen::Vector3d loops;
};

std::ostream& operator<<(std::ostream& out, const Scales& scales) {
  return out << scales.name;
}

// A motion as such a measurement sees it; one that says next to nothing is still near.
Pose measured(const Pose& motion, const Eigen::Vector3d& information, RandomStream& random) {
  const auto error = [&](int axis) {
    return std::min(1.0 / std::sqrt(information(axis)), 0.02) * random.normal();
  };
  return compose(motion, {error(0), error(1), error(2)});
}

MeasurementLog log_of(const Scales& scales) {
  constexpr std::size_t kKeyframes = 40;
  const std::vector<Pose> truth = test::circle(kKeyframes);
  RandomStream random(7, "scales");
  MeasurementLog log;
  const auto between_free = [&](std::size_t from, std::size_t to, const Eigen::Vector3d& I) {
    RelativePose z;
    z.from = from;
    z.to = to;
    z.motion = measured(between(truth[from], truth[to]), I, random);
    z.information = I.asDiagonal();
    return z;
  };
  for (std::size_t k = 1; k < kKeyframes; ++k) {
    log.add_keyframe(between_free(k - 1, k, scales.steps));
    if (k > 20 && k % 6 == 0) log.add_registration(between_free(k - 20, k, scales.loops));
  }
  log.add_registration(between_free(0, kKeyframes - 1, scales.loops));
  return log;
}

class InformationScales : public testing::TestWithParam<Scales> {};

INSTANTIATE_TEST_SUITE_P(
    Logs, InformationScales,
    testing::Values(Scales{"weak_steps", {1e-6, 1e-6, 1e-6}, {1e12, 1e12, 1e12}},
                    Scales{"weaker_steps", {1e-9, 1e-9, 1e-9}, {1e12, 1e12, 1e12}},
                    Scales{"less_weak_steps", {1e-3, 1e-3, 1e-3}, {1e12, 1e12, 1e12}},
                    Scales{"weak_loops", {1e12, 1e12, 1e12}, {1e-6, 1e-6, 1e-6}},
                    Scales{"by_direction", {1e-6, 1e12, 1e-6}, {1e12, 1e-6, 1e12}},
                    Scales{"headings_alone", {1e-6, 1e-6, 1e12}, {1e12, 1e12, 1e-6}}),
    [](const auto& scales) { return scales.param.name; });

void expect_optimum(const MeasurementLog& log, const Estimator& estimator) {
  const ExtendedLeastSquares best(log, poses_of(estimator));
  EXPECT_LT(chi2(log, poses_of(estimator)), 1.0001 * best.cost() + 1e-14);
  for (std::size_t k = 1; k < log.size(); ++k) {
    const auto covariance = estimator.covariance(k);
    ASSERT_TRUE(covariance) << k;
    EXPECT_LT((*covariance - best.covariance(k)).norm(), 1e-3 * best.covariance(k).norm()) << k;
  }
}

TEST_P(InformationScales, EveryGraphEndsAtTheOptimum) {
  const MeasurementLog log = log_of(GetParam());
  for (const std::string name :
       {"ceres_pose_graph", "sparse_gauss_newton", "incremental_smoother"}) {
    const EstimatorEntry& entry = builtin_estimators().find(name);
    for (const SolveMode mode : {SolveMode::incremental, SolveMode::batch}) {
      if (mode == SolveMode::batch && !entry.can_batch) continue;
      SCOPED_TRACE(name + (mode == SolveMode::batch ? ", batch" : ", incremental"));
      const auto estimator = entry.create({log.start(), mode}, {});
      EXPECT_EQ(test::feed(*estimator, log), Outcome::converged);
      expect_optimum(log, *estimator);
    }
  }
}

// Keyframes that come after an update whose factor is not kept.
TEST(InformationScalesAfterwards, MotionsToTheNewestGoOn) {
  MeasurementLog log = log_of({"", {1e-6, 1e-6, 1e-6}, {1e12, 1e12, 1e12}});
  log.add_keyframe(RelativePose::from_covariance(log.size() - 1, log.size(), {1.0, 0.0, 0.0},
                                                 1e6 * Eigen::Matrix3d::Identity()));
  for (const std::string name :
       {"ceres_pose_graph", "sparse_gauss_newton", "incremental_smoother"}) {
    SCOPED_TRACE(name);
    const auto estimator = test::solved(name, log);
    const ExtendedLeastSquares best(log, poses_of(*estimator));
    const Eigen::Matrix3d C = best.covariance(log.size() - 1);
    const auto newest = estimator->newest_covariance();
    ASSERT_TRUE(newest);
    EXPECT_LT((*newest - C).norm(), 1e-6 * C.norm());
    EXPECT_TRUE(estimator->motions_to_newest());
  }
}

// With the errors of pictures among the unknowns, too, and not zero.
TEST(WhitenedRows, GiveTheStepAndTheCostOfTheSums) {
  const test::SharedWalk walk(12, 4, 5);
  const test::GraphParts parts = test::parts_of(walk.log);
  pose_graph::PictureStates states;
  std::size_t edge = 0;
  for (std::size_t k = 1; k < walk.log.size(); ++k) {
    ++edge;
    for (const RelativePose& z : walk.log.arrival(k).registrations) {
      if (z.shared) states.add(z, edge);
      ++edge;
    }
  }
  pose_graph::ExtendedGraph graph = states.extended(parts.edges, parts.nodes);
  std::vector<pose_graph::Node>& nodes = graph.nodes;
  ASSERT_GT(nodes.size(), walk.log.size());
  for (std::size_t n = walk.log.size(); n < nodes.size(); ++n) {
    nodes[n] = pose_graph::make_errors(0.3, -0.2, 0.1);
  }
  const auto symbolic = pose_graph::analyse_graph(graph.edges, static_cast<int>(nodes.size()));
  pose_graph::NormalEquations sums(symbolic, graph.edges);
  pose_graph::NormalEquations rows(symbolic, graph.edges);
  const double F = sums.linearise(nodes, pose_graph::Hessian::gauss_newton);
  EXPECT_NEAR(pose_graph::whitened_cost(graph.edges, nodes), F, 1e-12 * F);
  ASSERT_TRUE(sums.factorise());
  const std::vector<double>& expected = sums.solve_step();
  const auto promised = rows.solve_rows(nodes);
  ASSERT_TRUE(promised);
  EXPECT_NEAR(*promised, sums.predicted_decrease(), 1e-9 * *promised);
  std::vector<double> solution = sums.gradient();
  rows.solve(solution.data());
  for (std::size_t i = 0; i < expected.size(); ++i) {
    EXPECT_NEAR(solution[i], -expected[i], 1e-9) << i;
  }
  std::vector<pose_graph::Node> by_sums;
  std::vector<pose_graph::Node> by_rows;
  sums.move(nodes, by_sums);
  rows.move(nodes, by_rows);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    EXPECT_NEAR(by_rows[k].x, by_sums[k].x, 1e-9) << k;
    EXPECT_NEAR(by_rows[k].theta, by_sums[k].theta, 1e-9) << k;
  }
}

TEST(OwnSpread, IsOfAxesWhateverTheUnits) {
  EXPECT_DOUBLE_EQ(own_spread(5.0 * Eigen::Matrix3d::Identity()), 1.0);
  EXPECT_DOUBLE_EQ(own_spread(Eigen::Vector3d(3.0, 3.0, 1e12).asDiagonal()), 1.0);
  EXPECT_NEAR(own_spread(Eigen::Vector3d(1e12, 1.0, 1.0).asDiagonal()), 0.25e12, 1e3);
  EXPECT_DOUBLE_EQ(own_spread(Eigen::Vector3d(1.0, 0.0, 0.0).asDiagonal()), 1.0);
  Eigen::Matrix3d fix_beside = Eigen::Matrix3d::Identity();
  fix_beside.row(2) << 0.0, 2.0, 4.0;
  fix_beside.col(2) << 0.0, 2.0, 4.0;
  EXPECT_DOUBLE_EQ(own_spread(fix_beside), 1.0);
}

}  // namespace
}  // namespace fathom

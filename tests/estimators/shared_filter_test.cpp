// The filters where registrations are told what their pictures share, against a dense
// textbook filter, dense least squares and their own errors.

#include "tests/estimators/shared_filter.hpp"

#include <cstring>

#include <Eigen/Dense>
#include <gtest/gtest.h>

#include "fathom/core/chi_squared.hpp"
#include "src/harness/conformance/naive_least_squares.hpp"
#include "tests/estimators/naive_shared_filter.hpp"

namespace fathom::test {
namespace {

class SharedFilters : public SharedFilter {};

INSTANTIATE_TEST_SUITE_P(All, SharedFilters, kEachFilter, name_of);

class SharedFiltersOnPoses : public SharedFilter {};

INSTANTIATE_TEST_SUITE_P(All, SharedFiltersOnPoses, kEachFilterOnPoses, name_of);

NaiveError kind_of(const std::string& type) {
  if (type == "ekf") return NaiveError::world;
  return type == "invariant_ekf" ? NaiveError::invariant : NaiveError::first_estimates;
}

// Full covariances, headings through ±π, loops in both directions and several at once, of which
// some are told nothing.
TEST_P(SharedFiltersOnPoses, IsTheTextbookFilter) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    const SharedWalk walk(30, 4, seed);
    const auto estimator = builtin_estimators().find(type()).create({}, options());
    EXPECT_TRUE(is_done(feed(*estimator, walk.log)));
    const NaiveSharedFilter naive(walk.log, kind_of(type()), model() == "states");
    EXPECT_LT(largest_distance(poses_of(*estimator), naive.poses()), 1e-9);
    EXPECT_LT(largest_turn(poses_of(*estimator), naive.poses()), 1e-9);
    const Eigen::MatrixXd expected = naive.covariance().bottomRightCorner(87, 87);
    EXPECT_LT(largest_block_difference(whole_covariance(*estimator), expected), 1e-9);
    const auto& errors = filter_of(*estimator).picture_errors();
    EXPECT_EQ(errors.blocks().size(), 30U);
    for (std::size_t k = 0; k < 30; ++k) {
      EXPECT_LT((errors.estimate(k) - naive.n(k)).norm(), 1e-8) << k;
    }
  }
}

// What nobody estimates stays as it was said, to the last bit.
TEST_P(SharedFiltersOnPoses, ConsideredErrorsKeepTheirPrior) {
  const SharedWalk walk(30, 4, 1);
  const auto estimator = solved(type(), walk.log, options());
  const auto& filter = filter_of(*estimator);
  EXPECT_EQ(filter.estimates_shared_errors(), model() == "states");
  EXPECT_EQ(estimator->estimates_shared_errors(), model() == "states");
  if (model() == "states") return;
  for (const Eigen::Index i : filter.picture_errors().blocks()) {
    for (const Eigen::Index j : filter.picture_errors().blocks()) {
      const Eigen::Matrix3d expected =
          i == j ? Eigen::Matrix3d::Identity().eval() : Eigen::Matrix3d::Zero().eval();
      EXPECT_EQ(filter.state_covariance().block(i, j), expected) << i << " " << j;
    }
  }
  const Eigen::MatrixXd P = filter.state_covariance().full();
  EXPECT_EQ((P - P.transpose()).norm(), 0.0);
}

// The gain is what it is, and P says what errors it leaves.
TEST_P(SharedFilters, ItsCovarianceIsThatOfItsErrors) {
  const RedrawnWalk walk(SharedWalk(14, 4, 5), kSmall);
  const auto estimator = solved(type(), walk.log(Eigen::VectorXd::Zero(walk.numbers())), options());
  EXPECT_LT(largest_block_difference(whole_covariance(*estimator),
                                     covariance_of_errors(type(), options(), walk)),
            1e-5);
  const Eigen::MatrixXd careless = whole_covariance(
      *solved(type(), walk.log(Eigen::VectorXd::Zero(walk.numbers())), sharing("independent")));
  EXPECT_GT(largest_block_difference(careless,
                                     covariance_of_errors(type(), sharing("independent"), walk)),
            0.1);
}

struct Nees {
  double newest = 0.0;
  double all = 0.0;
};

constexpr int kWalks = 200;
constexpr std::size_t kKeyframes = 20;

// Of the newest keyframe and of all jointly, over walks with errors of this share of their own.
Nees nees_of_walks(const std::string& type, const std::string& model, double size) {
  Nees sum;
  for (std::uint64_t i = 0; i < kWalks; ++i) {
    const RedrawnWalk walk(SharedWalk(kKeyframes, 4, i), size);
    const auto estimator = solved(type, walk.log(drawn_errors(walk.numbers(), i)), sharing(model));
    Eigen::VectorXd error(3 * (kKeyframes - 1));
    for (std::size_t k = 1; k < kKeyframes; ++k) {
      auto own = error.segment<3>(static_cast<Eigen::Index>(3 * (k - 1)));
      own = estimator->pose(k).vector() - walk.truth()[k].vector();
      own.z() = wrap_angle(own.z());
    }
    const Eigen::MatrixXd P = whole_covariance(*estimator);
    sum.all += error.dot(P.ldlt().solve(error));
    const Eigen::Vector3d newest = error.tail<3>();
    sum.newest += newest.dot(P.bottomRightCorner<3, 3>().ldlt().solve(newest));
  }
  return sum;
}

// 95 % of χ². Of the newest keyframe with the walk's full errors; of all keyframes jointly, which
// own errors of millimetres tie together, with a tenth of them: one linearisation does no better.
TEST_P(SharedFilters, IsHonest) {
  const auto expect_of = [](double nees, double dof) {
    EXPECT_GT(nees, chi_squared_quantile(0.025, dof));
    EXPECT_LT(nees, chi_squared_quantile(0.975, dof));
  };
  const double dof = 3.0 * kWalks;
  const double dof_of_all = dof * (kKeyframes - 1);
  const Nees large = nees_of_walks(type(), model(), 1.0);
  const Nees small = nees_of_walks(type(), model(), 0.1);
  RecordProperty("anees", std::to_string(large.newest / dof));
  RecordProperty("anees_of_all", std::to_string(large.all / dof_of_all));
  RecordProperty("anees_of_all_small", std::to_string(small.all / dof_of_all));
  expect_of(large.newest, dof);
  expect_of(small.newest, dof);
  expect_of(small.all, dof_of_all);
}

class FilterThatAsks : public testing::TestWithParam<std::string> {};

INSTANTIATE_TEST_SUITE_P(All, FilterThatAsks, testing::ValuesIn(all_filters()),
                         [](const auto& name) { return name.param; });

// Where everything is linear the filter is the batch.
TEST_P(FilterThatAsks, OfSmallErrorsIsLeastSquares) {
  const RedrawnWalk walk(SharedWalk(30, 4, 8), kSmall);
  const MeasurementLog log = walk.log(drawn_errors(walk.numbers(), 1));
  for (const auto& [model, errors] : {std::pair{"states", RegistrationErrors::shared},
                                      std::pair{"independent", RegistrationErrors::independent}}) {
    const NaiveLeastSquares expected = least_squares(log, 10, {}, errors);
    const auto estimator = solved(GetParam(), log, sharing(model));
    // Errors are of 1e-8 m and more.
    EXPECT_LT(largest_distance(poses_of(*estimator), expected.poses), 1e-6 * kSmall);
    EXPECT_LT(largest_turn(poses_of(*estimator), expected.poses), 1e-6 * kSmall);
    EXPECT_LT(largest_block_difference(whole_covariance(*estimator), expected.covariance), 2e-6);
  }
}

// To estimate n never makes poses worse.
TEST_P(FilterThatAsks, ConsideringIsNeverBetterThanEstimating) {
  for (const std::uint64_t seed : {3, 4}) {
    const RedrawnWalk walk(SharedWalk(25, 4, seed), kSmall);
    const MeasurementLog log = walk.log(drawn_errors(walk.numbers(), seed));
    const Eigen::MatrixXd estimated = whole_covariance(*solved(GetParam(), log, sharing("states")));
    const Eigen::MatrixXd considered =
        whole_covariance(*solved(GetParam(), log, sharing("consider")));
    // In units of the estimated: whatever the poses' own are.
    const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> ratios(considered, estimated,
                                                                           Eigen::EigenvaluesOnly);
    EXPECT_GT(ratios.eigenvalues().minCoeff(), 1.0 - 1e-5);
    EXPECT_GT(ratios.eigenvalues().maxCoeff(), 1.1);
  }
}

bool same_bits(const Estimator& a, const Estimator& b) {
  const std::vector<Pose> poses_a = poses_of(a);
  const std::vector<Pose> poses_b = poses_of(b);
  const Eigen::MatrixXd P_a = whole_covariance(a);
  const Eigen::MatrixXd P_b = whole_covariance(b);
  return std::memcmp(poses_a.data(), poses_b.data(), poses_a.size() * sizeof(Pose)) == 0 &&
         std::memcmp(P_a.data(), P_b.data(),
                     static_cast<std::size_t>(P_a.size()) * sizeof(double)) == 0;
}

// As if independent is to ask nothing, and who is told nothing need not be asked.
TEST_P(FilterThatAsks, WithoutPartsTheModelIsOfNoEffect) {
  const SharedWalk walk(30, 4, 6);
  MeasurementLog untold;
  for (std::size_t k = 1; k < walk.log.size(); ++k) {
    untold.add_keyframe(walk.log.arrival(k).step);
    for (RelativePose z : walk.log.arrival(k).registrations) {
      z.shared = nullptr;
      untold.add_registration(z);
    }
  }
  const auto expected = solved(GetParam(), walk.log, sharing("independent"));
  for (const char* model : {"states", "consider", "independent"}) {
    EXPECT_TRUE(same_bits(*solved(GetParam(), untold, sharing(model)), *expected)) << model;
  }
  EXPECT_FALSE(same_bits(*solved(GetParam(), walk.log, sharing("states")), *expected));
}

}  // namespace
}  // namespace fathom::test

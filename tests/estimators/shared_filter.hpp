#pragma once

#include <memory>
#include <numeric>
#include <string>
#include <tuple>
#include <vector>

#include <gtest/gtest.h>

#include "estimators/support/filter/delayed_state.hpp"
#include "estimators/trajectory_iekf/trajectory_iekf.hpp"
#include "tests/estimators/logs.hpp"
#include "tests/estimators/redrawn_walk.hpp"

/// The filters with each model of what pictures share.
namespace fathom::test {

/// Errors of this share of a SharedWalk's are linear in a filter, to 1e-6 of themselves.
constexpr double kSmall = 1e-5;

inline std::vector<std::string> filters_on_poses() {
  return {"ekf", "invariant_ekf", "first_estimates_ekf"};
}

inline std::vector<std::string> all_filters() {
  std::vector<std::string> all = filters_on_poses();
  all.push_back("trajectory_iekf");
  return all;
}

inline EstimatorValues sharing(const std::string& model) {
  return values({{"shared_errors", model}});
}

inline const filter::DelayedStateFilter& filter_of(const Estimator& estimator) {
  const auto& anchored = dynamic_cast<const AnchoredEstimator&>(estimator);
  return dynamic_cast<const filter::DelayedStateFilter&>(anchored.relative());
}

inline const filter::PictureErrorStates& picture_errors_of(const Estimator& estimator) {
  const auto& anchored = dynamic_cast<const AnchoredEstimator&>(estimator);
  const auto* iekf = dynamic_cast<const TrajectoryIekf*>(&anchored.relative());
  return iekf != nullptr ? iekf->blocks().pictures() : filter_of(estimator).picture_errors();
}

/// Of all keyframes but 0.
inline Eigen::MatrixXd whole_covariance(const Estimate& estimator) {
  std::vector<std::size_t> all(estimator.size() - 1);
  std::iota(all.begin(), all.end(), std::size_t{1});
  return estimator.joint_covariance(all).value();
}

/// The covariance that the poses of a filter have, told by its errors alone: a filter of a walk
/// with small errors is a linear function of them, δX = M e, and Cov δX = M Mᵀ. One column of M for
/// each number of the walk that has a part in it.
inline Eigen::MatrixXd covariance_of_errors(const std::string& type, const EstimatorValues& options,
                                            const RedrawnWalk& walk) {
  const auto n = static_cast<Eigen::Index>(3 * (walk.keyframes() - 1));
  Eigen::MatrixXd M(n, walk.numbers());
  for (Eigen::Index e = 0; e < M.cols(); ++e) {
    const auto estimator =
        solved(type, walk.log(Eigen::VectorXd::Unit(walk.numbers(), e)), options);
    for (std::size_t k = 1; k < walk.keyframes(); ++k) {
      Eigen::Vector3d error = estimator->pose(k).vector() - walk.truth()[k].vector();
      error.z() = wrap_angle(error.z());
      M.block<3, 1>(static_cast<Eigen::Index>(3 * (k - 1)), e) = error;
    }
  }
  return M * M.transpose();
}

/// Every filter with one of the models that ask.
class SharedFilter : public testing::TestWithParam<std::tuple<std::string, std::string>> {
 protected:
  std::string type() const { return std::get<0>(GetParam()); }
  std::string model() const { return std::get<1>(GetParam()); }
  EstimatorValues options() const { return sharing(model()); }
};

inline const auto kEachFilterOnPoses =
    testing::Combine(testing::ValuesIn(filters_on_poses()), testing::Values("states", "consider"));
inline const auto kEachFilter =
    testing::Combine(testing::ValuesIn(all_filters()), testing::Values("states", "consider"));

inline std::string name_of(const testing::TestParamInfo<SharedFilter::ParamType>& info) {
  return std::get<0>(info.param) + "_" + std::get<1>(info.param);
}

}  // namespace fathom::test

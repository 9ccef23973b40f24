#include <cmath>

#include <gtest/gtest.h>

#include "small_survey.hpp"

namespace fathom {
namespace {

using Errors = std::vector<Eigen::Vector3d>;

// Of every measured motion of a trial, from frame 1 on.
Errors errors_of(const SimulatedSurvey& survey) {
  Errors errors;
  for (std::size_t i = 1; i < survey.size(); ++i) {
    const Pose truth = between(*survey.info(i - 1).ground_truth, *survey.info(i).ground_truth);
    Eigen::Vector3d e = survey.info(i).motion->mean.vector() - truth.vector();
    e.z() = wrap_angle(e.z());
    errors.push_back(e);
  }
  return errors;
}

OdometryOptions drifting(double share) {
  OdometryOptions odometry;
  odometry.covariance = {4e-4, 1e-4, -1e-5, 2e-4, 2e-5, 5e-5};
  odometry.correlated_share = share;
  odometry.correlation_length_m = 0.8;
  return odometry;
}

Eigen::Matrix3d covariance() {
  return drifting(0.0).noise_covariance("");
}

class CorrelatedOdometry : public testing::Test {
 protected:
  CorrelatedOdometry() : survey(test::small_survey(), 3) {
    ways_m.push_back(0.0);
    for (std::size_t i = 2; i < survey.size(); ++i) {
      const Pose step = between(*survey.info(i - 1).ground_truth, *survey.info(i).ground_truth);
      ways_m.push_back(ways_m.back() + step.position().norm());
    }
  }

  // Of the errors of motions i and k, by the closed form.
  Eigen::Matrix3d expected(std::size_t i, std::size_t k, double share) const {
    const double way_m = std::abs(ways_m[i] - ways_m[k]);
    const double white = i == k ? 1.0 - share : 0.0;
    return (white + share * std::exp(-way_m / 0.8)) * covariance();
  }

  SimulatedSurvey survey;
  std::vector<double> ways_m;  ///< of the end of each motion, behind that of the first
};

TEST_F(CorrelatedOdometry, HasVarianceAndAutocorrelationOfTheClosedForm) {
  constexpr int kTrials = 4000;
  constexpr double kShare = 0.4;
  const std::vector<std::size_t> motions{0, 1, 2, 5, ways_m.size() - 1};
  std::vector<Eigen::Matrix3d> moments(motions.size(), Eigen::Matrix3d::Zero());
  Eigen::Matrix3d of_sum = Eigen::Matrix3d::Zero();
  for (int trial = 0; trial < kTrials; ++trial) {
    const Errors errors = errors_of(survey.remeasured(drifting(kShare), 3, trial));
    for (std::size_t j = 0; j < motions.size(); ++j) {
      moments[j] += errors[1] * errors[motions[j]].transpose() / kTrials;
    }
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    for (const Eigen::Vector3d& e : errors) sum += e;
    of_sum += sum * sum.transpose() / kTrials;
  }
  // Isserlis: the variance of a product of two normal values; within four standard deviations.
  const auto expect_near = [](const Eigen::Matrix3d& found, const Eigen::Matrix3d& cross,
                              const Eigen::Matrix3d& own) {
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        const double variance = own(r, r) * own(c, c) + cross(r, c) * cross(r, c);
        EXPECT_NEAR(found(r, c), cross(r, c), 4 * std::sqrt(variance / kTrials)) << r << ' ' << c;
      }
    }
  };
  for (std::size_t j = 0; j < motions.size(); ++j) {
    SCOPED_TRACE(motions[j]);
    expect_near(moments[j], expected(1, motions[j], kShare), covariance());
  }
  // What adds up over the survey: far more than what the steps say.
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (std::size_t i = 0; i < ways_m.size(); ++i) {
    for (std::size_t k = 0; k < ways_m.size(); ++k) sum += expected(i, k, kShare);
  }
  expect_near(of_sum, sum, sum);
  EXPECT_GT(sum(0, 0), 1.5 * static_cast<double>(ways_m.size()) * covariance()(0, 0));
}

TEST_F(CorrelatedOdometry, StatesTheCovarianceOfItsSteps) {
  for (const double share : {0.0, 0.4, 1.0}) {
    const SimulatedSurvey trial = survey.remeasured(drifting(share), 3, 1);
    for (std::size_t i = 1; i < trial.size(); ++i) {
      EXPECT_EQ(trial.info(i).motion->covariance, covariance());
    }
  }
}

TEST_F(CorrelatedOdometry, OfNoShareIsTheWhiteNoiseOfTheSameSeed) {
  OdometryOptions white;
  white.covariance = drifting(0.0).covariance;
  const SimulatedSurvey a = survey.remeasured(white, 3, 1);
  const SimulatedSurvey b = survey.remeasured(drifting(0.0), 3, 1);
  for (std::size_t i = 1; i < a.size(); ++i) {
    EXPECT_EQ(a.info(i).motion->mean, b.info(i).motion->mean);
  }
}

}  // namespace
}  // namespace fathom
